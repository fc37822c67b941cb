//! Specs as TOML, and their JSON Schema.

use glam::DVec3;

use super::located::{Entry, Kind, Node};
use super::{TreeError, TreeSpec};

/// Vertices and triangles, or points alone, of a file that a spec names.
pub type NamedMesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// Reads a spec.
///
/// `open` gives what is in a file named by `file = "..."` in an obstacle or envelope of shape `mesh` (vertices and
/// triangles) or `points`; `None` for a file that is not there. The core opens no files itself.
///
/// # Errors
/// [`TreeError::Spec`] with the line of what is wrong; [`TreeError::File`] for a file that `open` did not give.
pub fn read_tree_spec(text: &str, open: &dyn Fn(&str) -> Option<NamedMesh>) -> Result<TreeSpec, TreeError> {
    let fault = |message: String, at: usize| {
        let line = line_of(text, at.min(text.len()), &message);
        TreeError::Spec { line, message }
    };
    let mut tree = Node::from_toml(text).map_err(|f| fault(f.message, f.at))?;
    resolve(&mut tree, open)?;
    tree.read().map_err(|(e, at)| fault(e.to_string(), at))
}

/// Reads a spec that is kept as JSON.
///
/// # Errors
/// What is wrong.
pub(crate) fn spec_from_json(value: &serde_json::Value) -> Result<TreeSpec, serde_json::Error> {
    Node::from_json(value).read().map_err(|(e, _)| e)
}

/// The line (from 1) of a fault. Inside tables with a `kind` or `shape` the parser only knows where the table starts:
/// then the line is that of the field which the message names.
fn line_of(text: &str, at: usize, message: &str) -> usize {
    let start = text.get(..at).map_or(0, |t| t.matches('\n').count());
    let named = message.split('`').nth(1).filter(|_| message.starts_with("unknown "));
    let holds = |line: &str| {
        let name = named.unwrap_or_default();
        let trimmed = line.trim_start();
        let quoted = line.contains(&format!("\"{name}\""));
        let key = |rest: &str| rest.trim_start().starts_with(['=', '.', ']']);
        let inline = line.split(['{', ',']).any(|part| part.trim_start().strip_prefix(name).is_some_and(key));
        quoted || trimmed.trim_start_matches('[').strip_prefix(name).is_some_and(key) || inline
    };
    let found = named.and_then(|_| text.lines().skip(start).position(&holds).map(|k| start + k));
    let found = found.or_else(|| named.and_then(|_| text.lines().position(&holds)));
    found.unwrap_or(start) + 1
}

/// Puts meshes and points in the place of their files' names.
fn resolve(tree: &mut Node, open: &dyn Fn(&str) -> Option<NamedMesh>) -> Result<(), TreeError> {
    let at = tree.at;
    let entries = match &mut tree.kind {
        Kind::Table(entries) => entries,
        Kind::List(all) => return all.iter_mut().try_for_each(|node| resolve(node, open)),
        _ => return Ok(()),
    };
    let text = |name: &str| match entries.iter().find(|e| e.key == name).map(|e| &e.node.kind) {
        Some(Kind::Text(text)) => Some(text.clone()),
        _ => None,
    };
    let shape = text("shape").filter(|s| s == "mesh" || s == "points");
    let Some((shape, file)) = shape.zip(text("file")) else {
        return entries.iter_mut().try_for_each(|e| resolve(&mut e.node, open));
    };
    let (vertices, triangles) = open(&file).ok_or(TreeError::File { file })?;
    let list = |all: Vec<Kind>| Kind::List(all.into_iter().map(|kind| Node { kind, at }).collect());
    let points = list(vertices.iter().map(|p| list(p.to_array().map(Kind::Number).to_vec())).collect());
    entries.retain(|e| e.key != "file");
    let mut put = |key: &str, kind| entries.push(Entry { key: key.to_owned(), at, node: Node { kind, at } });
    if shape == "mesh" {
        let corners = |t: &[u32; 3]| list(t.map(|i| Kind::Whole(i64::from(i))).to_vec());
        put("vertices", points);
        put("triangles", list(triangles.iter().map(corners).collect()));
    } else {
        put("points", points);
    }
    Ok(())
}

/// The JSON Schema of [`TreeSpec`], with units (`x-unit`), ranges and defaults.
///
/// ```
/// let schema = burgeon::tree_schema();
/// assert_eq!(schema["properties"]["clearance_m"]["x-unit"], "m");
/// ```
pub fn tree_schema() -> serde_json::Value {
    schemars::schema_for!(TreeSpec).to_value()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> (usize, String) {
        match read_tree_spec(text, &|_| None) {
            Err(TreeError::Spec { line, message }) => (line, message),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn slips_are_named_with_their_line() {
        let (at, message) = line("name = \"a\"\n\nnmae = \"b\"\n");
        assert!(at == 3 && message.contains("unknown field `nmae`"), "{at} {message}");
        let (at, message) = line("name = \"a\"\n[method]\nkind = \"competition\"\npoints = 300\nkil_m = 2\n");
        assert!(at == 5 && message.contains("`kil_m`"), "{at} {message}");
        let (at, message) =
            line("[method]\nkind = \"competition\"\nenvelope = { shape = \"sphere\", radus = 2 }\n");
        assert!(at == 3, "{at} {message}");
        let (at, message) = line("[method]\nkind = \"magic\"\n");
        assert!(at == 2 && message.contains("`magic`"), "{at} {message}");
        let (at, _) = line("name = \"a\"\nroots = [[0, 0, 0]\n[method]\n");
        assert!((2..=3).contains(&at), "{at}");
        let (at, message) = line("age = -1\n");
        assert!(at == 1 && message.contains("-1"), "{at} {message}");
        let (at, message) = line("[wood]\nrelax = 1\ntip_radius_m = \"thin\"\n");
        assert!(at == 3 && message.contains("\"thin\""), "{at} {message}");
        let (at, message) = line("[look]\nbark = \"birch\"\nleaf_color = \"green\"\n");
        assert!(at == 3 && message.contains("`green`"), "{at} {message}");
        let (at, message) = line("roots = [\n  [0, 0, 0],\n  [1, 0],\n]\n");
        assert!(at == 3 && message.contains("2"), "{at} {message}");
        let (at, message) = line("name = \"a\"\nspecies = 1979-05-27\n");
        assert!(at == 2 && message.contains("date"), "{at} {message}");
        let (at, message) = line("name = \"a\"\nage = 99999999999999999999\n");
        assert!(at == 2 && message.contains("overflow"), "{at} {message}");
    }

    #[test]
    fn a_spec_is_the_same_as_toml_and_as_json() {
        for preset in crate::PRESETS {
            let spec = preset.spec().expect("sound");
            let value = serde_json::to_value(&spec).expect("plain data");
            assert_eq!(spec_from_json(&value).ok().as_ref(), Some(&spec), "{}", preset.key);
            // The reader that everybody knows says the same.
            assert_eq!(serde_json::from_value::<TreeSpec>(value).ok(), Some(spec), "{}", preset.key);
        }
        let wrong = serde_json::json!({ "wood": { "relax": "much" } });
        assert!(
            spec_from_json(&wrong).is_err_and(|e| e.to_string().contains("much")),
            "words are no numbers"
        );
    }

    #[test]
    fn files_are_put_in_place() {
        let text = "[[obstacles]]\nshape = \"mesh\"\nfile = \"rock.obj\"\n[method]\nkind = \"competition\"\n\
                    [method.envelope]\nshape = \"points\"\nfile = \"crown.xyz\"\nreach_m = 0.5\n";
        let open = |name: &str| match name {
            "rock.obj" => Some((vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])),
            "crown.xyz" => Some((vec![DVec3::Y], vec![])),
            _ => None,
        };
        let spec = read_tree_spec(text, &open).expect("sound");
        let rock = growth::Obstacle::Mesh {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(spec.obstacles, [rock]);
        let growth::Method::Competition(c) = &spec.method else { panic!("{:?}", spec.method) };
        assert_eq!(c.envelope, growth::Envelope::Points { points: vec![DVec3::Y], reach_m: 0.5 });
        let missing = read_tree_spec(text, &|_| None);
        assert!(
            matches!(missing, Err(TreeError::File { file }) if file == "crown.xyz" || file == "rock.obj")
        );
    }

    #[test]
    fn specs_come_back_from_their_file_form() {
        let spec = TreeSpec { age: Some(3), bare: true, ..TreeSpec::default() };
        let text = serde_json::to_string(&spec).expect("plain data");
        assert_eq!(serde_json::from_str::<TreeSpec>(&text).ok(), Some(spec), "{text}");
    }

    /// Every number of the schema that has a range, by its path.
    fn ranges(
        schema: &serde_json::Value,
        at: &serde_json::Value,
        path: &str,
        out: &mut Vec<(String, f64, f64)>,
    ) {
        let at = match at["$ref"].as_str().and_then(|r| schema.pointer(r.trim_start_matches('#'))) {
            Some(target) => target,
            None => at,
        };
        if let (Some(lo), Some(hi)) = (at["minimum"].as_f64(), at["maximum"].as_f64()) {
            out.push((path.to_owned(), lo, hi));
        }
        for (name, inner) in at["properties"].as_object().into_iter().flatten() {
            ranges(schema, inner, &format!("{path}/{name}"), out);
        }
    }

    /// A value outside its range is an error that names the field.
    fn refused(base: &TreeSpec, path: &str, (lo, hi): (f64, f64)) {
        for outside in [lo - 1.0, hi + hi.abs().max(1.0)] {
            let mut value = serde_json::to_value(base).expect("plain data");
            let Some(field) = value.pointer_mut(path) else { panic!("{path} in {base:?}") };
            #[expect(clippy::cast_possible_truncation, reason = "small ranges")]
            let whole = serde_json::json!(outside as i64);
            *field = if field.is_u64() { whole } else { serde_json::json!(outside) };
            // Negative counts do not even parse.
            let Ok(spec) = serde_json::from_value::<TreeSpec>(value) else { continue };
            let options = super::super::TreeOptions::default();
            let got = super::super::make_tree(&spec, base::Seed::new(1), &options, &base::Run::plain());
            let name = path.rsplit('/').next().expect("a name");
            let text = got.map(|_| ()).expect_err(&format!("{path} = {outside}")).to_string();
            assert!(text.contains(name), "{path}: {text}");
        }
    }

    #[test]
    fn the_schema_has_ranges_and_units_and_they_are_enforced() {
        let schema = tree_schema();
        let mut all = Vec::new();
        ranges(&schema, &schema, "", &mut all);
        assert!(all.len() >= 24, "{}: {all:?}", all.len());
        for (path, lo, hi) in &all {
            refused(&TreeSpec::default(), path, (*lo, *hi));
        }
        let method = schema["properties"]["method"]["$ref"].as_str().expect("a definition");
        let method = schema.pointer(method.trim_start_matches('#')).expect("is there");
        let mut seen = 0;
        for variant in method["oneOf"].as_array().expect("one of several") {
            let kind = variant["properties"]["kind"]["const"].as_str().expect("a kind");
            let more = match kind {
                "colonization" => {
                    "points = 50\nenvelope = { shape = \"sphere\", centre = [0, 3, 0], radius_m = 1 }\nsteps = {}"
                }
                "points" => "points = [[0, 1, 0]]\nsteps = {}",
                "lsystem" => "most_modules = 100\nrules = \"axiom = F\"",
                _ => "",
            };
            let text = format!("[method]\nkind = \"{kind}\"\n{more}");
            let base = read_tree_spec(&text, &|_| None).expect(kind);
            let mut own = Vec::new();
            ranges(&schema, variant, "/method", &mut own);
            for (path, lo, hi) in &own {
                // Of modules more than the most are cut down to it: a limit, not a fault.
                if !path.ends_with("most_modules") {
                    refused(&base, path, (*lo, *hi));
                }
            }
            seen += own.len();
        }
        assert!(seen > 30, "{seen}");
    }
}

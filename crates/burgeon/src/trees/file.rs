//! Specs as TOML, and their JSON Schema.

use glam::DVec3;
use growth::{GrowthError, TreeSpec};
use spec::{Entry, Kind, Node, Spec, SpecFault, line_at};

use super::TreeError;

/// Vertices and triangles, or points alone, of a file that a spec names.
pub type NamedMesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// Reads a spec.
///
/// `open` returns the contents of a file named by `file = "..."` in an obstacle or envelope of shape `mesh` (vertices
/// and triangles) or `points`, in metres, +Y up; `None` for a file that does not exist. The core opens no files itself.
///
/// # Errors
/// [`TreeError::Spec`] with the line of the fault (ranges are checked when the tree grows); [`TreeError::File`] for a
/// file that `open` did not return.
pub fn read_tree_spec(text: &str, open: &dyn Fn(&str) -> Option<NamedMesh>) -> Result<TreeSpec, TreeError> {
    let fault = |f| TreeError::Spec(SpecFault::in_text(text, f));
    let mut tree = Node::from_toml(text).map_err(fault)?;
    resolve(&mut tree, open)?;
    tree.read().map_err(fault)
}

impl TreeError {
    /// Adds to the error what the reader of a spec's file needs: `text` is the text that [`read_tree_spec`] read.
    ///
    /// A number out of range and a faulty obstacle get their line where the text has them, an obstacle the name of its
    /// file; lines of an L-system's rules count from the start of the file instead of the rules.
    #[must_use]
    pub fn in_text(self, text: &str) -> Self {
        let Ok(tree) = Node::from_toml(text) else { return self };
        match self {
            Self::Growth(GrowthError::Lsystem(e)) => {
                let rules = tree.field("method").and_then(|m| m.field("rules"));
                let first = rules.and_then(|rules| first_line(text, rules.at));
                Self::Growth(GrowthError::Lsystem(first.map_or(e.clone(), |first| e.from_line(first))))
            }
            Self::Growth(GrowthError::Obstacle { obstacle, mut name, fault }) => {
                let Some(Kind::List(all)) = tree.field("obstacles").map(|o| &o.kind) else {
                    return Self::Growth(GrowthError::Obstacle { obstacle, name, fault });
                };
                if let Some(Kind::Text(file)) =
                    all.get(obstacle).and_then(|o| o.field("file")).map(|f| &f.kind)
                {
                    name = base::quoted(file);
                }
                let place = all.get(obstacle).map(|o| match &*fault {
                    GrowthError::Field { field, .. } => o.field(field).map_or(o.at, |f| f.at),
                    GrowthError::Range(range) => o.at_path(&range.path).map_or(o.at, |f| f.at),
                    _ => o.at,
                });
                let error = GrowthError::Obstacle { obstacle, name, fault };
                place.map_or_else(|| Self::Growth(error.clone()), |at| at_line(text, at, &error))
            }
            Self::Growth(GrowthError::Range(fault)) => {
                let line = tree.at_path(&fault.path).map(|node| line_at(text, node.at));
                Self::Spec(SpecFault::Range { line, fault })
            }
            Self::Growth(ref error @ GrowthError::Field { field, value, .. }) => {
                let mut found = Vec::new();
                let name = field.rsplit('.').next().unwrap_or(field);
                places(&tree, name, value, &mut found);
                // If there are several, the one meant is unknown.
                if let [at] = found[..] { at_line(text, at, error) } else { self }
            }
            other => other,
        }
    }
}

fn at_line(text: &str, at: usize, error: &GrowthError) -> TreeError {
    TreeError::Line { line: line_at(text, at), error: error.clone() }
}

/// Returns the line on which the content of a string of several lines starts; `None` for one on a single line.
fn first_line(text: &str, at: usize) -> Option<usize> {
    let rest = text.get(at..)?;
    let inside = rest.strip_prefix("\"\"\"").or_else(|| rest.strip_prefix("'''"))?;
    Some(line_at(text, at) + usize::from(inside.starts_with('\n') || inside.starts_with("\r\n")))
}

/// Finds the places where fields of this name have this value.
fn places(node: &Node, name: &str, value: f64, found: &mut Vec<usize>) {
    for entry in node.entries() {
        let number = match entry.node.kind {
            Kind::Number(x) => Some(x),
            #[expect(clippy::cast_precision_loss, reason = "to be compared with a number of a message")]
            Kind::Whole(n) => Some(n as f64),
            _ => None,
        };
        if entry.key == name && number.is_some_and(|x| x.to_bits() == value.to_bits()) {
            found.push(entry.node.at);
        }
        places(&entry.node, name, value, found);
    }
    if let Kind::List(all) = &node.kind {
        all.iter().for_each(|n| places(n, name, value, found));
    }
}

/// Replaces the names of files by their meshes and points.
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

/// Returns the JSON Schema of [`TreeSpec`], with units (`x-unit`), ranges and defaults.
///
/// ```
/// let schema = burgeon::tree_schema();
/// assert_eq!(schema["properties"]["clearance_m"]["x-unit"], "m");
/// ```
pub fn tree_schema() -> &'static serde_json::Value {
    TreeSpec::schema()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> (usize, String) {
        match read_tree_spec(text, &|_| None) {
            Err(TreeError::Spec(SpecFault::Text { line: Some(line), path, message })) if path.is_empty() => {
                (line, message)
            }
            Err(TreeError::Spec(SpecFault::Text { line: Some(line), path, message })) => {
                (line, format!("{path}: {message}"))
            }
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
    fn faults_inside_tagged_tables_are_named_with_field_and_line() {
        for (text, at, path) in [
            (
                "name = \"a\"\n\n[method]\nkind = \"competition\"\npoints = 300\nkill_m = \"two\"\n",
                6,
                "method.kill_m: ",
            ),
            ("[method]\nkind = \"competition\"\n# kill\nlifespan = -1\n", 4, "method.lifespan: "),
            (
                "[method]\nkind = \"competition\"\n[method.envelope]\nshape = \"sphere\"\ncentre = [0, 1]\nradius_m = 1\n",
                5,
                "method.envelope.centre",
            ),
            (
                "[method]\nkind = \"competition\"\n[method.envelope]\nshape = \"ball\"\n",
                4,
                "method.envelope.shape: unknown variant",
            ),
            (
                "[method]\nkind = \"competition\"\n[[method.tropisms]]\ndirection = [0, 1, 0]\nstrength = 1\n[[method.tropisms]]\ndirection = [0, 1, 0]\nstrength = true\n",
                8,
                "method.tropisms[1].strength: ",
            ),
            (
                "[[obstacles]]\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n[[obstacles]]\nshape = \"box\"\nmin = [0, 0, 0]\n",
                5,
                "obstacles[1]: missing field `max`",
            ),
            ("[method]\nkind = \"lsystem\"\nmost_modules = 10\n", 1, "method: missing field `rules`"),
        ] {
            let (line, message) = line(text);
            assert!(line == at && message.starts_with(path), "{text}: line {line}: {message}");
        }
        let (_, message) = line(&format!("[method]\nkind = \"{}\"\n", "x".repeat(3_000_000)));
        assert!(message.len() < 300, "{} bytes", message.len());
    }

    #[test]
    fn errors_of_growth_get_their_lines_in_the_file() {
        let told = |text: &str| {
            let spec =
                read_tree_spec(text, &|_| Some((vec![DVec3::ZERO; 3], vec![[0, 1, 2]]))).expect("sound");
            let options = super::super::TreeOptions::default();
            let made = super::super::make_tree(&spec, base::Seed::new(1), &options, &base::Run::plain());
            made.map(|_| ()).expect_err("not sound").in_text(text).to_string()
        };
        let rules =
            |rules: &str| format!("name = \"a\"\n\n[method]\nkind = \"lsystem\"\nmost_modules = 99\n{rules}");
        for (text, want) in [
            (rules("rules = '''\naxiom = A\nA -> F(\n'''\n"), "line 8: a number"),
            (rules("rules = \"\"\"axiom = A\nA -> F(\"\"\"\n"), "line 7: a number"),
            (rules("rules = \"\"\"\n\naxiom = A\nsteps = 9\nA -> A A A\n\"\"\"\n"), "`A -> A A A` in line 10 lets"),
            ("[wood]\nrelax = 99\n".into(), "line 2: wood.relax must be 0 to 10, not 99"),
            ("[method]\nkind = \"competition\"\nkill_m = nan\n".into(), "line 3: method.kill_m must"),
            ("[[obstacles]]\nshape = \"sphere\"\ncentre = [9, 0, 0]\nradius_m = 1\n[[obstacles]]\nshape = \"sphere\"\ncentre = [9, 0, 0]\nradius_m = 0\n".into(),
             "line 8: obstacles[1].radius_m must be 1e-6 to 1,000,000 m, not 0"),
            ("[[obstacles]]\nshape = \"mesh\"\nfile = \"rock.obj\"\n".into(), "line 1: obstacle 1 (rock.obj): mesh: it has no triangle"),
        ] {
            let told = told(&text);
            assert!(told.contains(want), "{text}: {told}");
        }
    }

    #[test]
    fn a_spec_is_the_same_as_toml_and_as_json() {
        for preset in crate::PRESETS {
            let spec = preset.spec().expect("sound");
            let value = serde_json::to_value(&spec).expect("plain data");
            assert_eq!(spec::from_json(&value).ok().as_ref(), Some(&spec), "{}", preset.key);
            // Serde's well-known reader gives the same.
            assert_eq!(serde_json::from_value::<TreeSpec>(value).ok(), Some(spec), "{}", preset.key);
        }
        let wrong = serde_json::json!({ "wood": { "relax": "much" } });
        let error = spec::from_json::<TreeSpec>(&wrong).expect_err("words are no numbers").to_string();
        assert!(error.starts_with("wood.relax: ") && error.contains("much"), "{error}");
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

    /// Collects every number of the schema that has a range, by its path.
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

    /// Checks that a value outside its range is an error that names the field.
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
        ranges(schema, schema, "", &mut all);
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
            ranges(schema, variant, "/method", &mut own);
            for (path, lo, hi) in &own {
                // Excess modules are cut: this is a limit, not a fault.
                if !path.ends_with("most_modules") {
                    refused(&base, path, (*lo, *hi));
                }
            }
            seen += own.len();
        }
        assert!(seen > 30, "{seen}");
    }
}

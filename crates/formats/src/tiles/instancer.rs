//! A stand as USD: plants in their own files, each with many places.

use std::io::Write as _;

use super::tile::{Instance, TreeTable};
use crate::error::WriteError;

/// A plant with many places.
#[derive(Clone, Debug)]
pub struct Prototype<'a> {
    /// Path of its file, relative to that of the stand.
    pub file: &'a str,
    /// Its places; [`Instance::tree`] is a row of the table.
    pub instances: &'a [Instance],
}

/// Returns the text of a USD layer with a `PointInstancer` over plants of other layers, which it references, in
/// metres, +Y up. The attributes of a tree (`primvars:row`, `species`, `height_m`, `dbh_m`, `crown_width_m`,
/// `age_years`) have one value for each place; `ids` are rows of the inventory, and the names of species are custom
/// data of the layer.
///
/// Guaranteed: the same input gives the same bytes.
///
/// # Errors
/// [`WriteError::Io`], which does not occur, because the layer is written into memory.
pub fn stand_usda(prototypes: &[Prototype<'_>], table: &TreeTable<'_>) -> Result<Vec<u8>, WriteError> {
    let all = || {
        let own = prototypes.iter().enumerate();
        own.flat_map(|(k, p)| p.instances.iter().map(move |i| (k, i)))
    };
    let rows = || all().filter_map(|(_, i)| table.rows.get(i.tree as usize));
    let mut out = Vec::new();
    writeln!(out, "#usda 1.0\n(\n    defaultPrim = \"forest\"")?;
    writeln!(out, "    doc = \"Burgeon {}\"", env!("CARGO_PKG_VERSION"))?;
    let species: Vec<String> = table.species.iter().map(|s| quoted(s)).collect();
    writeln!(out, "    customLayerData = {{\n        string[] species = [{}]\n    }}", species.join(", "))?;
    writeln!(out, "    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n")?;
    writeln!(out, "def Xform \"forest\" (\n    kind = \"assembly\"\n)\n{{")?;
    writeln!(out, "    def PointInstancer \"trees\"\n    {{")?;
    let targets: Vec<String> =
        (0..prototypes.len()).map(|k| format!("</forest/trees/prototypes/plant{k}>")).collect();
    writeln!(out, "        rel prototypes = [{}]", targets.join(", "))?;
    let column = |out: &mut Vec<u8>, head: &str, values: &mut dyn Iterator<Item = String>| {
        let values: Vec<String> = values.collect();
        writeln!(out, "        {head} = [{}]", values.join(", "))
    };
    column(&mut out, "int[] protoIndices", &mut all().map(|(k, _)| k.to_string()))?;
    column(&mut out, "int64[] ids", &mut rows().map(|t| t.row.to_string()))?;
    let triple = |[x, y, z]: [f64; 3]| format!("({x:.4}, {y:.4}, {z:.4})");
    column(&mut out, "point3f[] positions", &mut all().map(|(_, i)| triple(i.at.to_array())))?;
    let quat = |i: &Instance| {
        let q = i.turn;
        format!("({:.4}, {:.4}, {:.4}, {:.4})", q.w, q.x, q.y, q.z)
    };
    column(&mut out, "quath[] orientations", &mut all().map(|(_, i)| quat(i)))?;
    column(&mut out, "float3[] scales", &mut all().map(|(_, i)| triple(i.scale.to_array())))?;
    column(&mut out, "int[] primvars:species", &mut rows().map(|t| t.species.to_string()))?;
    column(&mut out, "float[] primvars:height_m", &mut rows().map(|t| format!("{:.3}", t.height_m)))?;
    column(&mut out, "float[] primvars:dbh_m", &mut rows().map(|t| format!("{:.4}", t.dbh_m)))?;
    column(
        &mut out,
        "float[] primvars:crown_width_m",
        &mut rows().map(|t| format!("{:.3}", t.crown_width_m)),
    )?;
    column(&mut out, "float[] primvars:age_years", &mut rows().map(|t| format!("{:.1}", t.age_years)))?;
    writeln!(out, "\n        def Scope \"prototypes\"\n        {{")?;
    for (k, prototype) in prototypes.iter().enumerate() {
        writeln!(
            out,
            "            def Xform \"plant{k}\" (\n                prepend references = @{}@",
            prototype.file
        )?;
        writeln!(out, "            )\n            {{\n            }}")?;
    }
    writeln!(out, "        }}\n    }}\n}}")?;
    Ok(out)
}

fn quoted(text: &str) -> String {
    let kept: String = text.chars().filter(|c| !c.is_control()).collect();
    format!("\"{}\"", kept.replace('\\', "\\\\").replace('"', "\\\""))
}

//! A vein graph as JSON: nodes with radii, edges.

use std::io::Read;

use base::{Unit, Warning};
use glam::DVec2;
use leaf::VeinGraph;
use serde::Deserialize;

use super::LeafFileError;
use crate::error::{FileFault, Place};

// Most nodes: ten times the network of a leaf traced at 1200 dots per inch.
const MAX_NODES: usize = 100_000;

/// Contents of a file of a vein graph.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadGraph {
    /// The network in metres, y upwards; in units of the file if `unit` is none.
    pub graph: VeinGraph,
    /// The unit of the file; none for pixels.
    pub unit: Option<Unit>,
    /// Warnings of the reader.
    pub warnings: Vec<Warning>,
}

#[derive(Deserialize)]
struct GraphFile {
    #[serde(default)]
    unit: Option<String>,
    #[serde(alias = "nodes")]
    nodes_xyr: Vec<[f64; 3]>,
    edges: Vec<[u32; 2]>,
}

/// Reads a vein graph: `{"unit": "pixel", "nodes_xyr": [[x, y, radius], ...], "edges": [[0, 1], ...]}`.
///
/// `unit` is `m`, `cm`, `mm` or `pixel` (and `px`, the default). Pixels have y downwards, as in images, lengths
/// have y upwards. Edges name nodes from 0.
///
/// # Errors
/// [`LeafFileError`] for text that is not such JSON, an unknown unit, and more than 100,000 nodes.
pub fn read_vein_graph(input: impl Read) -> Result<ReadGraph, LeafFileError> {
    let file = |fault| LeafFileError::new(Place::File, fault);
    let text = super::text(input)?;
    if text.trim().is_empty() {
        return Err(file(FileFault::Empty));
    }
    let read: GraphFile = serde_json::from_str(&text).map_err(|e| {
        let place = Place::Line { line: e.line() as u64, column: Some(e.column() as u64) };
        let advice = "a vein graph is {\"unit\": \"mm\", \"nodes_xyr\": [[x, y, radius], ...], \"edges\": [[0, 1], ...]}";
        LeafFileError::new(place, FileFault::malformed(e.to_string(), advice))
    })?;
    if read.nodes_xyr.len() > MAX_NODES {
        return Err(file(FileFault::TooMuch {
            what: "the number of nodes",
            limit: MAX_NODES as u64,
            advice: "leave the smallest veins out",
        }));
    }
    let unit = match read.unit.as_deref().map(str::to_ascii_lowercase).as_deref() {
        None | Some("pixel" | "pixels" | "px") => None,
        Some(word) => Some(Unit::from_word(word).ok_or_else(|| {
            let what = format!("the unit \"{word}\" is not known");
            file(FileFault::malformed(what, "a unit is m, cm, mm or pixel"))
        })?),
    };
    let metres = unit.map_or(1.0, Unit::metres);
    let up = if unit.is_some() { metres } else { -metres };
    let mut graph = VeinGraph {
        nodes: read.nodes_xyr.iter().map(|n| DVec2::new(n[0] * metres, n[1] * up)).collect(),
        radii: read.nodes_xyr.iter().map(|n| n[2] * metres).collect(),
        edges: read.edges,
    };
    let mut warnings = Vec::new();
    let before = graph.edges.len();
    graph.edges.retain(|[a, b]| a != b);
    if graph.edges.len() < before {
        let message =
            format!("{} edges join a node with itself and were left out", before - graph.edges.len());
        warnings.push(Warning { code: "edge-loop", message, fields: Vec::new() });
    }
    Ok(ReadGraph { graph, unit, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_y_downwards_and_lengths_upwards() {
        let text =
            r#"{"unit": "pixel", "nodes_xyr": [[1, 2, 0.5], [3, 4, 0.25]], "edges": [[0, 1], [1, 1]]}"#;
        let read = read_vein_graph(text.as_bytes()).unwrap();
        assert_eq!(
            (read.unit, read.graph.nodes[1], read.graph.radii[1]),
            (None, DVec2::new(3.0, -4.0), 0.25)
        );
        assert_eq!((read.graph.edges.len(), read.warnings.len()), (1, 1));
        let read = read_vein_graph(text.replace("pixel", "mm").as_bytes()).unwrap();
        assert!((read.graph.nodes[1] - DVec2::new(0.003, 0.004)).length() < 1e-12);
    }

    #[test]
    fn faults_say_where_and_what_to_do() {
        let message = |text: &str| read_vein_graph(text.as_bytes()).unwrap_err().to_string();
        assert!(message("").contains("empty"));
        assert!(message("[1]").contains("nodes_xyr"));
        assert!(message(r#"{"unit": "mile", "nodes_xyr": [], "edges": []}"#).contains("a unit is m, cm"));
        assert!(message(r#"{"nodes_xyr": [[1, 2]], "edges": []}"#).contains("line 1, column"));
        assert!(message(r#"{"nodes_xyr": [[1, 2, 3]], "edges": [[0, -1]]}"#).contains("line 1"));
    }
}

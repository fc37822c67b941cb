//! One oak by three methods, as paper 001 compares them in its Table 2.

use growth::Grown;

/// Method and preset of each oak, in the paper's order.
pub const OAK_METHODS: [(&str, &str); 3] =
    [("L-system", "oak-lsystem"), ("space colonization", "oak-colonization"), ("space competition", "oak")];

/// A row that the paper prints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperOak {
    /// Method.
    pub method: &'static str,
    /// Vertices, thousands.
    pub vertices_k: f64,
    /// Triangles, thousands.
    pub triangles_k: f64,
    /// Seconds.
    pub seconds: f64,
}

/// Paper 001, Table 2.
pub const PAPER_OAKS: [PaperOak; 3] = [
    PaperOak { method: "L-system", vertices_k: 601.0, triangles_k: 635.6, seconds: 45.0 },
    PaperOak { method: "space colonization", vertices_k: 117.8, triangles_k: 147.2, seconds: 8.0 },
    PaperOak { method: "space competition", vertices_k: 105.2, triangles_k: 122.1, seconds: 9.0 },
];

/// How large a tree is, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeSize {
    /// From the ground to the highest node.
    pub height_m: f64,
    /// Mean of the crown's extents along x and z.
    pub crown_m: f64,
}

/// Measures the wood of a tree.
pub fn tree_size(grown: &Grown) -> TreeSize {
    let mut bounds = mesh::Bounds::EMPTY;
    grown.plant.nodes.position.iter().for_each(|p| bounds.include(*p));
    let size = bounds.size();
    let height_m = if bounds.is_empty() { 0.0 } else { bounds.max.y };
    TreeSize { height_m, crown_m: 0.5 * (size.x + size.z) }
}

/// Enlarges or shrinks a whole tree about its root until it is `height_m` high, above 0; leaves keep their size.
///
/// The tree stays as it is where it has no height.
pub fn scale_to_height(grown: &mut Grown, height_m: f64) {
    let now = tree_size(grown).height_m;
    let factor = height_m / now;
    if !(now > 1e-9 && factor.is_finite() && factor > 0.0) {
        return;
    }
    let plant = &mut grown.plant;
    plant.nodes.position.iter_mut().for_each(|p| *p *= factor);
    plant.nodes.radius_m.iter_mut().for_each(|r| *r *= factor);
    plant.organs.iter_mut().for_each(|o| o.frame.origin *= factor);
    plant.flowers.iter_mut().for_each(|f| f.centre *= factor);
}

//! Tests whether a mesh is closed and which way it faces: for warnings, as growth tolerates both.

use std::collections::BTreeMap;

use glam::DVec3;

/// Returns the number of edges that bound one triangle only, with coincident vertices merged. 0 for a closed mesh.
///
/// Triangles that name vertices that do not exist are skipped. Cost: n log n.
///
/// ```
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let closed = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// assert_eq!(growth::open_edges(&corners, &closed), 0);
/// assert_eq!(growth::open_edges(&corners, &closed[1..]), 3);
/// ```
pub fn open_edges(vertices: &[DVec3], triangles: &[[u32; 3]]) -> usize {
    let mut uses: BTreeMap<([u64; 3], [u64; 3]), u32> = BTreeMap::new();
    // Adding 0 turns -0 into 0, which is the same coordinate.
    let place = |i: u32| vertices.get(i as usize).map(|p| p.to_array().map(|c| (c + 0.0).to_bits()));
    for &[a, b, c] in triangles {
        let (Some(a), Some(b), Some(c)) = (place(a), place(b), place(c)) else { continue };
        for (p, q) in [(a, b), (b, c), (c, a)] {
            if p != q {
                *uses.entry((p.min(q), p.max(q))).or_insert(0) += 1;
            }
        }
    }
    uses.values().filter(|&&n| n % 2 == 1).count()
}

/// Returns the volume that a closed mesh bounds, m3; negative if its faces point inwards.
///
/// ```
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let closed = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// assert!((growth::signed_volume(&corners, &closed) - 1.0 / 6.0).abs() < 1e-12);
/// assert!(growth::signed_volume(&corners, &closed.map(|[a, b, c]| [a, c, b])) < 0.0);
/// ```
pub fn signed_volume(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let middle = vertices.first().copied().unwrap_or_default();
    let place = |i: u32| vertices.get(i as usize).map(|p| *p - middle);
    let volume = |&[a, b, c]: &[u32; 3]| Some(place(a)?.dot(place(b)?.cross(place(c)?)) / 6.0);
    triangles.iter().filter_map(volume).sum()
}

//! Shapes for collisions: closed, convex, as large as the wood.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh::TriMesh;
use plant::{AxisKind, NodeId, Plant};
use skin::{colliders, joined_colliders};

fn corner_at(mesh: &TriMesh, corner: u32) -> DVec3 {
    DVec3::from_array(mesh.positions[corner as usize].map(f64::from))
}

fn volume(mesh: &TriMesh) -> f64 {
    let six = |t: &[u32; 3]| corner_at(mesh, t[0]).dot(corner_at(mesh, t[1]).cross(corner_at(mesh, t[2])));
    mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

#[test]
fn a_rod_is_one_frustum_of_its_own_volume() {
    let mut p = Plant::default();
    p.add_axis(AxisKind::Branch, None, 1, &[DVec3::ZERO, DVec3::new(0.3, 2.0, -0.4)], None);
    p.nodes.radius_m = vec![0.02, 0.01];
    let shapes = colliders(&p);
    assert_eq!(shapes.len(), 1);
    let length = DVec3::new(0.3, 2.0, -0.4).length();
    let wood = std::f64::consts::PI / 3.0 * length * (0.02 * 0.02 + 0.02 * 0.01 + 0.01 * 0.01);
    assert!((volume(&shapes[0]) / wood - 1.0).abs() < 1e-4, "{} of {wood}", volume(&shapes[0]));
}

#[test]
fn each_shape_is_closed_and_convex() {
    let mut p = Plant::default();
    let bent = [DVec3::ZERO, DVec3::Y, DVec3::new(0.6, 1.8, 0.0), DVec3::new(1.5, 2.0, 0.3)];
    p.add_axis(AxisKind::Branch, None, 1, &bent, None);
    p.add_axis(AxisKind::Branch, Some(NodeId::new(1)), 2, &[DVec3::Y, DVec3::new(-1.0, 1.5, 0.2)], None);
    p.add_axis(AxisKind::Root, None, 3, &[DVec3::ZERO, DVec3::NEG_Y], None);
    p.nodes.radius_m = vec![0.1, 0.08, 0.06, 0.0, 0.05, 0.02, 0.1, 0.05];
    let shapes = colliders(&p);
    assert_eq!(shapes.len(), 4, "three straight runs and a limb, no root");
    for shape in &shapes {
        let mut edges = BTreeMap::new();
        for t in &shape.triangles {
            (0..3).for_each(|k| *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1);
            let [a, b, c] = t.map(|corner| corner_at(shape, corner));
            let out = (b - a).cross(c - a).normalize();
            let over = (0..12).map(|k| (corner_at(shape, k) - a).dot(out)).fold(f64::MIN, f64::max);
            // Corners are f32: a hundredth of a millimetre.
            assert!(over < 1e-5, "nothing lies before a face: {over}");
        }
        assert!(edges.iter().all(|(&(a, b), &n)| n == 1 && edges.get(&(b, a)) == Some(&1)));
    }
    assert_eq!(joined_colliders(&shapes).triangles.len(), 80);
    assert!(colliders(&Plant::default()).is_empty());
}

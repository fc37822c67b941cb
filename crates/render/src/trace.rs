//! First surfaces that single rays meet, from any place in any direction.

use core::fmt;

use base::{Cancelled, Run};
use glam::{DVec2, DVec3};
use mesh::Model;

use crate::camera::Camera;
use crate::hits::Hit;
use crate::scene::Scene;
use crate::spec::PictureSpec;

/// Most triangles of a leaf of the tree of boxes.
const LEAF: usize = 4;
/// Most boxes that wait while the tree is searched: one a level, and a tree over 2^32 triangles has 31.
const WAITING: usize = 64;
/// Least component of a direction when it is divided by: its box is then met or missed without infinities.
const LEAST_WAY: f64 = 1e-200;

/// A box around some triangles: `count` of them from `first` on, or, with a count of 0, the boxes `first` and
/// `first + 1`.
struct Node {
    low: DVec3,
    high: DVec3,
    first: u32,
    count: u32,
}

/// A triangle: its first corner, and the ways from there to the others.
struct Facet {
    corner: DVec3,
    edges: [DVec3; 2],
    row: u32,
}

/// The surfaces of a model, in a tree of boxes (Kay and Kajiya 1986) whose branches have equally many triangles.
///
/// As for [`crate::hits`], unsound input is left out, holes of textures let rays through, and what is below the ground
/// is hidden. Cost: `n log n` for `n` triangles to make; about `log n` for a ray.
///
/// ```
/// use glam::DVec3;
/// let mut mesh = mesh::TriMesh::default();
/// mesh.positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// mesh.triangles = vec![[0, 1, 2]];
/// let look = mesh::Material::plain("plain", mesh::MaterialKind::Other, [0.5; 3]);
/// let part = mesh::Part { name: "one".into(), material: mesh::MaterialId::new(0), mesh };
/// let model = mesh::Model { parts: vec![part], materials: vec![look], ..Default::default() };
/// let tracer = render::Tracer::new(&model, &base::Run::plain())?;
/// let hit = tracer.first(DVec3::new(0.2, 0.3, 2.0), DVec3::NEG_Z).expect("a hit");
/// assert_eq!((hit.at, hit.distance_m), (DVec3::new(0.2, 0.3, 0.0), 2.0));
/// # Ok::<(), base::Cancelled>(())
/// ```
pub struct Tracer {
    scene: Scene,
    nodes: Vec<Node>,
    facets: Vec<Facet>,
}

impl fmt::Debug for Tracer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tracer").field("triangles", &self.facets.len()).finish_non_exhaustive()
    }
}

/// Nearest triangle of a ray so far: its distance, its row in the facets, and the weights of its second and third
/// corner.
#[derive(Clone, Copy)]
struct Nearest {
    distance: f64,
    facet: usize,
    weights: DVec2,
}

impl Tracer {
    /// Prepares a model.
    ///
    /// # Errors
    /// [`Cancelled`] when the run was cancelled.
    pub fn new(model: &Model, run: &Run<'_>) -> Result<Self, Cancelled> {
        run.cancel.check()?;
        let scene = Scene::placed(model);
        let facet = |(row, t): (u32, &crate::scene::Triangle)| {
            let [a, b, c] = scene.corners(t).map(|v| v.at);
            Facet { corner: a, edges: [b - a, c - a], row }
        };
        let mut facets: Vec<Facet> = (0_u32..).zip(&scene.triangles).map(facet).collect();
        let mut nodes = Vec::with_capacity(facets.len() / 2 + 2);
        nodes.push(Node::around(&facets, 0));
        let mut open = vec![(0_usize, 0_usize, facets.len())];
        while let Some((node, first, end)) = open.pop() {
            if end - first <= LEAF {
                continue;
            }
            run.cancel.check()?;
            let own = &mut facets[first..end];
            let half = own.len() / 2;
            halve(own);
            let (left, right) = own.split_at(half);
            let children = nodes.len();
            nodes.push(Node::around(left, first));
            nodes.push(Node::around(right, first + half));
            (nodes[node].first, nodes[node].count) = (narrow(children), 0);
            open.extend([(children, first, first + half), (children + 1, first + half, end)]);
        }
        Ok(Self { scene, nodes, facets })
    }

    /// Returns the centre of the bounds of all surfaces, and the distance of their corners from there; `None` without
    /// surfaces.
    pub fn sphere(&self) -> Option<(DVec3, f64)> {
        let bounds = &self.scene.bounds;
        (!bounds.is_empty()).then(|| ((bounds.min + bounds.max) * 0.5, self.scene.radius()))
    }

    /// Returns the camera that shows all surfaces: [`Camera::framing`].
    pub fn camera(&self, spec: &PictureSpec) -> Camera {
        Camera::framing(&self.scene.points(), spec)
    }

    /// Returns the first point that a ray meets; `way`: a unit vector.
    pub fn first(&self, origin: DVec3, way: DVec3) -> Option<Hit> {
        self.bundle(origin, way, &[way]).pop()
    }

    /// Returns the first points that rays from one place meet, in the order of the rays; rays without one are left out.
    /// `pixel` is the row of the ray.
    ///
    /// `ways`: unit vectors near `axis`, a unit vector: the narrower the bundle, the less it costs. Most 64 rays.
    pub fn bundle(&self, origin: DVec3, axis: DVec3, ways: &[DVec3]) -> Vec<Hit> {
        let ways = &ways[..ways.len().min(MOST_RAYS)];
        let mut nearest: [Option<Nearest>; MOST_RAYS] = [None; MOST_RAYS];
        let spread = ways.iter().map(|w| w.distance_squared(axis)).fold(0.0, f64::max).sqrt();
        let inverse = axis.to_array().map(|x| 1.0 / if x.abs() < LEAST_WAY { LEAST_WAY } else { x });
        let inverse = DVec3::from_array(inverse);
        let mut waiting = [(0.0_f64, 0_u32); WAITING];
        let mut count = 0;
        if let Some(entry) = self.nodes[0].entry(origin, inverse, spread) {
            (waiting[0], count) = ((entry, 0), 1);
        }
        while count > 0 {
            count -= 1;
            let (entry, node) = waiting[count];
            let far = |n: &Option<Nearest>| n.map_or(f64::INFINITY, |n| n.distance);
            let farthest = nearest[..ways.len()].iter().map(far).fold(0.0, f64::max);
            if entry > farthest {
                continue;
            }
            let node = &self.nodes[node as usize];
            if node.count > 0 {
                let first = node.first as usize;
                for facet in first..first + node.count as usize {
                    for (way, nearest) in ways.iter().zip(&mut nearest) {
                        self.meet((origin, *way), facet, nearest);
                    }
                }
                continue;
            }
            let entries = [node.first, node.first + 1].map(|k| {
                self.nodes.get(k as usize).and_then(|n| Some((n.entry(origin, inverse, spread)?, k)))
            });
            let nearer_last = match entries {
                [Some(a), Some(b)] if a.0 < b.0 => [Some(b), Some(a)],
                other => other,
            };
            for child in nearer_last.into_iter().flatten() {
                if count < WAITING {
                    waiting[count] = child;
                    count += 1;
                }
            }
        }
        (0_u32..)
            .zip(ways)
            .zip(&nearest)
            .filter_map(|((row, way), found)| self.hit(row, (origin, *way), found.as_ref()?))
            .collect()
    }

    /// Keeps a triangle as the nearest of a ray if it is (Moeller and Trumbore 1997).
    fn meet(&self, (origin, way): (DVec3, DVec3), row: usize, nearest: &mut Option<Nearest>) {
        let facet = &self.facets[row];
        let [e1, e2] = facet.edges;
        let p = way.cross(e2);
        let det = e1.dot(p);
        if det == 0.0 {
            return;
        }
        let (inverse, s) = (1.0 / det, origin - facet.corner);
        let u = s.dot(p) * inverse;
        if !(0.0..=1.0).contains(&u) {
            return;
        }
        let q = s.cross(e1);
        let v = way.dot(q) * inverse;
        let distance = e2.dot(q) * inverse;
        let beyond = nearest.is_some_and(|n| n.distance <= distance);
        if v < 0.0 || u + v > 1.0 || distance <= 0.0 || !distance.is_finite() || beyond {
            return;
        }
        if origin.y + way.y * distance < self.scene.ground || self.is_hole(facet, u, v) {
            return;
        }
        *nearest = Some(Nearest { distance, facet: row, weights: DVec2::new(u, v) });
    }

    fn is_hole(&self, facet: &Facet, u: f64, v: f64) -> bool {
        let triangle = &self.scene.triangles[facet.row as usize];
        let surface = &self.scene.surfaces[triangle.surface as usize];
        let Some(texture) = surface.texture.as_ref().filter(|_| surface.mask) else { return false };
        let [a, b, c] = self.scene.corners(triangle);
        let at = (a.uv * (1.0 - u - v) + b.uv * u + c.uv * v).as_vec2();
        texture.hole(at.x, at.y)
    }

    fn hit(&self, pixel: u32, (origin, beam): (DVec3, DVec3), found: &Nearest) -> Option<Hit> {
        let facet = &self.facets[found.facet];
        let [part, triangle] = *self.scene.places.as_ref()?.get(facet.row as usize)?;
        let [e1, e2] = facet.edges;
        let normal = e1.cross(e2).normalize_or(-beam);
        let normal = if normal.dot(beam) > 0.0 { -normal } else { normal };
        // Of the triangle, not of the ray: on it to the last bit.
        let at = facet.corner + e1 * found.weights.x + e2 * found.weights.y;
        let distance_m = (at - origin).dot(beam);
        Some(Hit { pixel, part, triangle, at, normal, beam, distance_m })
    }
}

/// Most rays of a bundle.
const MOST_RAYS: usize = 64;

impl Node {
    fn around(facets: &[Facet], first: usize) -> Self {
        let corners = facets.iter().flat_map(|f| [f.corner, f.corner + f.edges[0], f.corner + f.edges[1]]);
        let (low, high) =
            corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        Self { low, high, first: narrow(first), count: narrow(facets.len()) }
    }

    /// Returns where the axis of a bundle enters the box, made larger by what the bundle has spread at its far end.
    fn entry(&self, origin: DVec3, inverse: DVec3, spread: f64) -> Option<f64> {
        let (middle, half) = ((self.low + self.high) * 0.5, (self.high - self.low) * 0.5);
        let off = middle - origin;
        let wide = half + spread * (off.length() + half.length());
        let (a, b) = ((off - wide) * inverse, (off + wide) * inverse);
        let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        (near <= far).then_some(near)
    }
}

/// Sorts triangles into two halves along the longest side of the box around their middles; equal ones by their rows.
fn halve(facets: &mut [Facet]) {
    let middle = |f: &Facet| f.corner * 3.0 + f.edges[0] + f.edges[1];
    let (low, high) = facets
        .iter()
        .map(middle)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let side = (high - low).to_array();
    let along = (0..3).max_by(|&a, &b| side[a].total_cmp(&side[b])).unwrap_or(0);
    facets.select_nth_unstable_by(facets.len() / 2, |a, b| {
        middle(a)[along].total_cmp(&middle(b)[along]).then(a.row.cmp(&b.row))
    });
}

fn narrow(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::{Draw, Seed};

    /// Triangles at random in a cube around (0, 3, 0).
    fn crowd(count: u32) -> Model {
        let mut s = Seed::new(4).stream(Draw::Test);
        let mut mesh = mesh::TriMesh::default();
        for k in 0..count {
            let at = DVec3::new(s.range(-1.0, 1.0), s.range(2.0, 4.0), s.range(-1.0, 1.0));
            for _ in 0..3 {
                let p = at + DVec3::new(s.range(-0.2, 0.2), s.range(-0.2, 0.2), s.range(-0.2, 0.2));
                mesh.positions.push(p.as_vec3().to_array());
            }
            mesh.triangles.push([3 * k, 3 * k + 1, 3 * k + 2]);
        }
        let look = mesh::Material::plain("plain", mesh::MaterialKind::Other, [0.5; 3]);
        let part = mesh::Part { name: "crowd".into(), material: mesh::MaterialId::new(0), mesh };
        Model { parts: vec![part], materials: vec![look], ..Model::default() }
    }

    #[test]
    fn the_tree_of_boxes_finds_what_a_search_of_all_triangles_finds() {
        let tracer = Tracer::new(&crowd(300), &Run::plain()).expect("not cancelled");
        let mut s = Seed::new(7).stream(Draw::Test);
        let mut met = 0;
        for k in 0..500 {
            let origin = DVec3::new(s.range(-4.0, 4.0), s.range(1.0, 5.0), s.range(-4.0, 4.0));
            let target = DVec3::new(s.range(-1.0, 1.0), s.range(2.0, 4.0), s.range(-1.0, 1.0));
            let axis = (target - origin).normalize();
            let spread = if k % 2 == 0 { 0.0 } else { 0.1 };
            let way = |_| {
                let off = DVec3::new(s.normal(), s.normal(), s.normal()) * spread;
                (axis + off).normalize()
            };
            let ways: Vec<DVec3> = (0..9).map(way).collect();
            let hits = tracer.bundle(origin, axis, &ways);
            for (row, way) in (0_u32..).zip(&ways) {
                let mut all = None;
                (0..tracer.facets.len()).for_each(|f| tracer.meet((origin, *way), f, &mut all));
                let found = hits.iter().find(|h| h.pixel == row).map(|h| h.triangle);
                assert_eq!(found, all.map(|n| tracer.facets[n.facet].row), "beam {k}, ray {row}");
                met += usize::from(found.is_some());
            }
        }
        assert!(met > 1000, "{met}");
    }

    #[test]
    fn rays_meet_what_the_beams_of_a_picture_meet() {
        let model = crowd(200);
        let spec = PictureSpec { width: 60, height: 60, ..PictureSpec::default() };
        let seen = crate::hits(&model, std::slice::from_ref(&spec), &Run::plain()).expect("not cancelled");
        let tracer = Tracer::new(&model, &Run::plain()).expect("not cancelled");
        let eye = tracer.camera(&spec).ray(DVec2::ZERO).0;
        let same = |h: &&Hit| {
            let found = tracer.first(eye, h.beam).map(|own| (own.triangle, own.at.distance(h.at) < 1e-3));
            found == Some((h.triangle, true))
        };
        let (all, same) = (seen[0].len(), seen[0].iter().filter(same).count());
        // A picture rounds corners to 1/256 of a pixel.
        assert!(all > 300 && same * 100 >= all * 97, "{same} of {all}");
    }

    #[test]
    fn along_an_axis_and_from_within_a_plane_no_ray_is_lost() {
        let tracer = Tracer::new(&crowd(1), &Run::plain()).expect("not cancelled");
        let facet = &tracer.facets[0];
        let middle = facet.corner + (facet.edges[0] + facet.edges[1]) / 3.0;
        for way in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
            assert!(tracer.first(middle - way, way).is_some(), "{way}");
            assert!(tracer.first(middle - way, -way).is_none(), "{way}");
        }
    }

    #[test]
    fn an_empty_model_has_no_sphere_and_no_hits() {
        let tracer = Tracer::new(&Model::default(), &Run::plain()).expect("not cancelled");
        assert!(tracer.sphere().is_none() && tracer.first(DVec3::ZERO, DVec3::X).is_none());
    }
}

//! Compound leaves and bundles of needles of a crown: a kite for each leaflet or needle, or a triangle at a low limit,
//! as many as the limit allows.
//!
//! `Blade -> lobes between its bays -> a wider selection of them -> triangles`

use glam::DVec2;
use mesh::TriMesh;
use plant::Blade;

use crate::blade::BladeChart;
use crate::sleeve::{drop_flat, narrow2};

/// Share of its margin without bays below which a blade is leaflets or needles rather than one surface.
const COMPOUND: f64 = 0.6;
/// Least number of lobes of a compound leaf: fewer are one leaf with lobes, as in maple.
const FEW_LOBES: usize = 6;
/// Largest ratio of width to length of a lobe that represents several, before it becomes longer, too.
const STOUT: f64 = 0.3;
/// Depth of inner corners of a lobe, relative to the straight line between their neighbours, below which they are not
/// bays, as a share of the blade's length.
const SHALLOW: f64 = 1e-3;

/// One leaflet or needle: a triangle from its root to its tip.
#[derive(Clone, Copy, Debug)]
struct Lobe {
    root: DVec2,
    tip: DVec2,
    /// Position of its greatest width, as a share of the length from root to tip, and its side.
    wide_at: f64,
    side: f64,
    area: f64,
}

/// Triangles per lobe from which it is a kite, on both sides of its midrib.
const FOR_KITES: f64 = 1.5;

/// Meshes a compound blade in at most about this number of triangles, one or two for each of its leaflets or needles;
/// the selected ones are wider, and then longer, to cover the area of all of them. `None` for a blade of another form,
/// and for one that must not be `wider` and has more lobes.
pub(crate) fn spikes(blade: &Blade, closed: &[DVec2], triangles: f64, wider: bool) -> Option<TriMesh> {
    let outline = &blade.outline;
    let area = geom::signed_area(outline);
    if area.is_nan() || area <= 0.0 || area > COMPOUND * geom::signed_area(closed) {
        return None;
    }
    let all = lobes(outline, SHALLOW * blade.length());
    let wanted = base::ops::whole(triangles.round()).max(2) as usize;
    let kites = triangles >= FOR_KITES * all.len() as f64;
    if all.len() < FEW_LOBES || all.len() > MOST_LOBES || !(wider || kites) {
        return None;
    }
    let kept = evenly(all.len(), wanted);
    let have: f64 = kept.iter().map(|&k| all[k].area).sum();
    let times = all.iter().map(|l| l.area).sum::<f64>() / have.max(f64::MIN_POSITIVE);
    let (mut mesh, chart, surface) = (TriMesh::default(), BladeChart::new(blade), blade.surface());
    for &k in &kept {
        let (corners, n) = (all[k].corners(times, kites), mesh.positions.len());
        for &p in &corners {
            let lifted = surface.point(p);
            mesh.push(if lifted.is_finite() { lifted } else { p.extend(0.0) });
            let uv = chart.uv(p.clamp(DVec2::new(-1.0, 0.0) * blade.length(), DVec2::ONE * blade.length()));
            mesh.uvs.push(narrow2(uv.x, uv.y));
        }
        mesh.triangles.extend((2..corners.len()).map(|c| [n, n + c - 1, n + c].map(crate::sleeve::index)));
    }
    drop_flat(&mut mesh);
    mesh.compute_normals();
    (!mesh.triangles.is_empty()).then_some(mesh)
}

/// Most lobes, as more would take long.
const MOST_LOBES: usize = 200;

/// Returns `wanted` indices of `n`, in the middles of equal parts.
fn evenly(n: usize, wanted: usize) -> Vec<usize> {
    let wanted = wanted.min(n).max(1);
    (0..wanted).map(|i| (2 * i + 1) * n / (2 * wanted)).collect()
}

/// Returns the parts between one bay and the next, all around from the root.
fn lobes(outline: &[DVec2], shallow: f64) -> Vec<Lobe> {
    let n = outline.len();
    let inner = |k: &usize| {
        let [a, b, c] = [outline[k - 1], outline[*k], outline[(k + 1) % n]];
        let chord = c - a;
        chord.perp_dot(b - a) > shallow * chord.length()
    };
    // Counter-clockwise, so a corner to the left of the path past it is concave.
    let bays: Vec<usize> =
        core::iter::once(0).chain((1..n).filter(inner)).chain(core::iter::once(n)).collect();
    bays.windows(2).enumerate().filter_map(|(k, w)| Lobe::measure(outline, w[0], w[1], k % 2 == 0)).collect()
}

impl Lobe {
    fn measure(outline: &[DVec2], from: usize, to: usize, other: bool) -> Option<Self> {
        let corners: Vec<DVec2> = (from..=to).map(|k| outline[k % outline.len()]).collect();
        let root = 0.5 * (corners[0] + *corners.last()?);
        let tip = corners.iter().copied().max_by(|a, b| root.distance(*a).total_cmp(&root.distance(*b)))?;
        let (along, area) = (tip - root, geom::signed_area(&corners));
        let length = along.length_squared();
        if corners.len() < 3 || area <= 0.0 || length <= 0.0 {
            return None;
        }
        let aside = |p: &DVec2| along.perp_dot(*p - root);
        let widest = corners.iter().max_by(|a, b| aside(a).abs().total_cmp(&aside(b).abs()))?;
        let side = if aside(widest) == 0.0 { if other { 1.0 } else { -1.0 } } else { aside(widest).signum() };
        Some(Self { root, tip, wide_at: (along.dot(*widest - root) / length).clamp(0.0, 1.0), side, area })
    }

    /// Returns a triangle or a kite, counter-clockwise, with `times` the lobe's area.
    fn corners(&self, times: f64, kite: bool) -> Vec<DVec2> {
        let along = self.tip - self.root;
        let width = 2.0 * times * self.area / along.length_squared();
        let longer = (width / STOUT).max(1.0).sqrt();
        let tip = self.root + along * longer;
        let (at, aside) = (self.root + along * (self.wide_at * longer), along.perp() * (width / longer));
        match (kite, self.side > 0.0) {
            (true, _) => vec![self.root, at - 0.5 * aside, tip, at + 0.5 * aside],
            (false, true) => vec![self.root, tip, at + aside],
            (false, false) => vec![self.root, at - aside, tip],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::BladeForm;

    fn closed(blade: &Blade) -> Vec<DVec2> {
        crate::lean::closed(blade).expect("a tip")
    }

    #[test]
    fn needles_and_leaflets_stay_apart_and_keep_their_area() {
        for (form, count) in
            [(BladeForm::Tuft, 7), (BladeForm::Brush, 11), (BladeForm::Pinnate, 11), (BladeForm::Feather, 17)]
        {
            let mut blade = form.blade();
            blade.relief = plant::Relief::default();
            for wish in [2.0, 3.0, 5.0, 40.0] {
                let mesh = spikes(&blade, &closed(&blade), wish, true).expect("a compound leaf");
                assert_eq!(mesh.validate().next(), None, "{form:?}");
                let each = if wish >= FOR_KITES * count as f64 { 2 } else { 1 };
                assert_eq!(
                    mesh.triangles.len(),
                    each * count.min(base::ops::whole(wish) as usize),
                    "{form:?}"
                );
                let area = |t: &[u32; 3]| {
                    let [a, b, c] = t.map(|i| mesh.position(i).truncate());
                    0.5 * (b - a).perp_dot(c - a)
                };
                let drawn: f64 = mesh.triangles.iter().map(area).sum();
                let share = drawn / geom::signed_area(&blade.outline);
                assert!((0.85..1.15).contains(&share), "{form:?}, {wish}: {share}");
                let far = mesh.positions.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f32::max);
                assert!(far < 1.5, "{form:?}, {wish}: a spear of {far}");
            }
        }
    }

    #[test]
    fn leaves_of_one_surface_are_left_to_others() {
        for form in BladeForm::ALL {
            let compound =
                matches!(form, BladeForm::Tuft | BladeForm::Brush | BladeForm::Pinnate | BladeForm::Feather);
            let blade = form.blade();
            assert_eq!(spikes(&blade, &closed(&blade), 4.0, true).is_some(), compound, "{form:?}");
            // If it must not be wider, it works only if each lobe has its own triangle.
            assert!(spikes(&blade, &closed(&blade), 4.0, false).is_none(), "{form:?}");
            assert_eq!(spikes(&blade, &closed(&blade), 40.0, false).is_some(), compound, "{form:?}");
        }
    }
}

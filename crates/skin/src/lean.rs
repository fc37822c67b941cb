//! Leaves of a crown: few triangles, spent on the corners that define their form.
//!
//! `Blade -> most significant corners -> two halves along the midrib -> ears`

use glam::DVec2;
use mesh::TriMesh;
use plant::Blade;

use crate::blade::BladeChart;
use crate::sleeve::{drop_flat, narrow2};
use crate::spikes::spikes;

/// Largest factor by which a blade of a coarser copy is drawn wider than its outline: enough for a kite that represents
/// a spray of needles. Others have at most [`plant::DRAWN_WIDER`].
pub(crate) const COPIED_WIDER: f64 = 6.0;

/// Factor beyond which a blade of a coarser copy has its bays closed instead of being drawn wider.
const WIDE: f64 = 1.5;

/// Share of its margin without bays below which a blade has lobes that define its form, as in maple or fig: few
/// triangles go to their tips and the bays between, and none to a midrib that bends.
const LOBED: f64 = 0.8;
/// Pairs of triangles from which there are enough for both.
const MANY_PAIRS: f64 = 3.0;

/// Largest ratio of the straight distance from root to tip to the length along the midrib at which a blade of a coarser
/// copy is drawn in steps along it.
const ARCHED: f64 = 0.97;
/// Largest half width of such a blade relative to its length: the corners of its form alone would lose its arch.
const SLENDER: f64 = 0.16;
/// Most triangles of an arched blade: more do not improve the arch.
const MOST_ARCHED: f64 = 16.0;

/// Meshes a slender arched blade, as of a grass or a palm, in equal steps along its midrib; `None` for others.
fn arched(blade: &Blade, triangles: f64, widest: f64) -> Option<TriMesh> {
    const PARTS: u32 = 12;
    let (outline, surface) = (&blade.outline, blade.surface());
    let tip = *blade.midrib.last()?;
    let way: Vec<_> = (0..=PARTS).map(|k| surface.point(tip * (f64::from(k) / f64::from(PARTS)))).collect();
    let along: f64 = way.windows(2).map(|w| w[0].distance(w[1])).sum();
    let straight = way[0].distance(way[way.len() - 1]);
    let leans = tip.x.abs() > SLENDER * tip.y;
    if leans || straight > ARCHED * along || half_width(outline) > SLENDER * tip.y {
        return None;
    }
    let steps = base::ops::whole(0.5 * triangles.clamp(2.0, MOST_ARCHED)) as usize;
    // Part of a line across the blade that lies in it.
    let across = |y: f64| {
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        let at = ends
            .filter(|(a, b)| (a.y <= y) != (b.y <= y))
            .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let (mut right, mut left) = (vec![DVec2::ZERO], vec![tip]);
    for k in 1..=steps {
        let y = tip.y * k as f64 / (steps + 1) as f64;
        let (low, high) = across(y);
        right.push(DVec2::new(high, y));
        left.insert(1, DVec2::new(low, y));
    }
    let points = [right, left].concat();
    if points.iter().any(|p| !p.is_finite()) || geom::signed_area(&points) <= 0.0 {
        return None;
    }
    let wider = DVec2::new((geom::signed_area(outline) / geom::signed_area(&points)).clamp(1.0, widest), 1.0);
    let n = points.len();
    let mut triangles = vec![[0, 1, n - 1].map(crate::sleeve::index)];
    for k in 1..steps {
        let (a, b, c, d) = (k, k + 1, n - k - 1, n - k);
        triangles.extend([[a, b, c], [a, c, d]].map(|t| t.map(crate::sleeve::index)));
    }
    triangles.push([steps, steps + 1, steps + 2].map(crate::sleeve::index));
    Some(bent(blade, &points, wider, triangles))
}

/// Makes the mesh of triangles between points of a blade's plane, drawn `wider` and bent as the blade is.
fn bent(blade: &Blade, points: &[DVec2], wider: DVec2, triangles: Vec<[u32; 3]>) -> TriMesh {
    let mut mesh = TriMesh { triangles, ..TriMesh::default() };
    let (chart, surface) = (BladeChart::new(blade), blade.surface());
    for &p in points {
        let lifted = surface.point(p * wider);
        mesh.push(if lifted.is_finite() { lifted } else { p.extend(0.0) });
        let uv = chart.uv(p);
        mesh.uvs.push(narrow2(uv.x, uv.y));
    }
    drop_flat(&mut mesh);
    mesh.compute_normals();
    mesh
}

/// Meshes a convex blade of three or four corners, such as a leaflet of a far copy, in the fewest triangles.
fn few_corners(blade: &Blade) -> Option<TriMesh> {
    let outline = &blade.outline;
    if outline.iter().any(|p| !p.is_finite()) || geom::signed_area(outline) <= 0.0 {
        return None;
    }
    let triangles = (2..crate::sleeve::index(outline.len())).map(|k| [0, k - 1, k]).collect();
    Some(bent(blade, outline, DVec2::ONE, triangles))
}

/// Meshes a blade in at most about `triangles` triangles, 2 to 60, folded along its midrib; widened up to `widest`
/// times to keep the area of its outline.
///
/// Guaranteed: root and tip stay, and of the other corners those that enclose most area with their neighbours
/// (Visvalingam and Whyatt 1993), so lobes and needles outlive smooth curves; texture as on finer blades. `None` if the
/// outline crosses itself, or its tip cannot be determined: then finer meshing must be used. Cost: quadratic in the
/// corners of the outline.
pub(crate) fn lean_mesh(blade: &Blade, triangles: f64, widest: f64) -> Option<TriMesh> {
    let outline = &blade.outline;
    if widest > WIDE && (3..=4).contains(&outline.len()) {
        return few_corners(blade);
    }
    if outline.len() < 4 || outline.len() > 400 || outline.iter().any(|p| !p.is_finite()) {
        return None;
    }
    let compound = closed(blade).and_then(|closed| spikes(blade, &closed, triangles, widest > WIDE));
    if let Some(mesh) = compound.or_else(|| arched(blade, triangles, widest).filter(|_| widest > WIDE)) {
        return Some(mesh);
    }
    let end = *blade.midrib.last()?;
    let tip = nearest(outline, end)?;
    let pairs = (0.5 * triangles.clamp(2.0, 60.0)).round();
    // With four triangles or more the midrib gets a point in its middle, so that the blade bends.
    let lobed =
        || closed(blade).is_some_and(|all| geom::signed_area(outline) < LOBED * geom::signed_area(&all));
    let with_middle = pairs >= 2.0 && (widest <= WIDE || pairs >= MANY_PAIRS || !lobed());
    let sides = base::ops::whole(pairs - f64::from(u8::from(with_middle))).max(1) as usize;
    let (kept, end) = corners(outline, (0..outline.len()).collect(), tip, 2 * sides + 2);
    let at = |kept: &[usize]| -> Vec<DVec2> { kept.iter().map(|&i| outline[i]).collect() };
    let (mut points, mut tip_at) = (at(&kept), end);
    // The area of the lost corners is compensated in width: a crown of such leaves is as full as it was.
    let lost =
        |points: &[DVec2]| geom::signed_area(outline) / geom::signed_area(points).max(f64::MIN_POSITIVE);
    let mut wider = lost(&points).clamp(1.0, widest);
    // Only the tips of deep lobes would remain, and drawn wide they would be spikes: their bays are closed instead.
    if widest > WIDE && wider * half_width(&points) > WIDE * half_width(outline) {
        let (kept, end) = corners(outline, without_bays(outline, tip), tip, 2 * sides + 2);
        let closed = at(&kept);
        let narrower = lost(&closed).clamp(1.0 / widest, widest);
        if narrower * half_width(&closed) < wider * half_width(&points) {
            (points, tip_at, wider) = (closed, end, narrower);
        }
    }
    let (tip, wider) = (tip_at, DVec2::new(wider, 1.0));
    if tip == 0 || geom::signed_area(&points) <= 0.0 || geom::self_crossings(&points) > 0 {
        return None;
    }
    let n = points.len();
    let (mut right, mut left): (Vec<usize>, Vec<usize>) = ((0..=tip).collect(), (tip..n).collect());
    left.push(0);
    if with_middle {
        points.push(middle(&blade.midrib));
        right.push(n);
        left.push(n);
    }
    let mut triangles = Vec::new();
    ears(&points, right, &mut triangles)?;
    ears(&points, left, &mut triangles)?;
    Some(bent(blade, &points, wider, triangles))
}

/// Returns a margin of `most` corners that keeps its form except for teeth; `None` if it has no more corners, or would
/// cross itself.
pub(crate) fn fewer_corners(blade: &Blade, most: usize) -> Option<Vec<DVec2>> {
    let outline = &blade.outline;
    if outline.len() <= most || outline.len() > MOST_CORNERS || outline.iter().any(|p| !p.is_finite()) {
        return None;
    }
    let tip = nearest(outline, *blade.midrib.last()?)?;
    let (kept, _) = corners(outline, (0..outline.len()).collect(), tip, most);
    let fewer: Vec<DVec2> = kept.iter().map(|&i| outline[i]).collect();
    (geom::signed_area(&fewer) > 0.0 && geom::self_crossings(&fewer) == 0).then_some(fewer)
}

/// Most corners among which the least significant are searched, as the time grows fast.
const MOST_CORNERS: usize = 2000;

fn nearest(points: &[DVec2], to: DVec2) -> Option<usize> {
    let far = |i: &usize| points[*i].distance_squared(to);
    (0..points.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// Returns the largest half width of points on both sides of the midrib.
fn half_width(points: &[DVec2]) -> f64 {
    points.iter().map(|p| p.x.abs()).fold(0.0, f64::max)
}

/// Returns the margin of a blade without its bays; `None` if its tip cannot be determined.
pub(crate) fn closed(blade: &Blade) -> Option<Vec<DVec2>> {
    let tip = nearest(&blade.outline, *blade.midrib.last()?)?;
    Some(without_bays(&blade.outline, tip).into_iter().map(|i| blade.outline[i]).collect())
}

/// Returns the corners of a margin, as indices, without its bays: only root and tip may be concave.
fn without_bays(outline: &[DVec2], tip: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::with_capacity(outline.len() + 1);
    // Once round, the root at both ends (Andrew's scan of a chain): concave corners are removed.
    for i in (0..outline.len()).chain([0]) {
        while let [.., a, b] = kept[..] {
            let inwards = (outline[b] - outline[a]).perp_dot(outline[i] - outline[a]) <= 0.0;
            if !inwards || b == tip {
                break;
            }
            kept.pop();
        }
        kept.push(i);
    }
    kept.pop();
    kept
}

/// Returns the remaining corners of those in `kept`, as indices, and which of them is the tip; the root is the first.
fn corners(outline: &[DVec2], mut kept: Vec<usize>, tip: usize, wanted: usize) -> (Vec<usize>, usize) {
    while kept.len() > wanted.max(4) {
        let n = kept.len();
        let area = |k: usize| {
            let [a, b, c] = [kept[k - 1], kept[k], kept[(k + 1) % n]].map(|i| outline[i]);
            (b - a).perp_dot(c - a).abs()
        };
        let least = (1..n).filter(|&k| kept[k] != tip).min_by(|&a, &b| area(a).total_cmp(&area(b)));
        let Some(k) = least else { break };
        kept.remove(k);
    }
    let at = kept.iter().position(|&i| i == tip).unwrap_or(0);
    (kept, at)
}

/// Returns the point halfway along a line.
fn middle(line: &[DVec2]) -> DVec2 {
    let length: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = 0.5 * length;
    for w in line.windows(2) {
        let d = w[0].distance(w[1]);
        if d >= left && d > 0.0 {
            return w[0].lerp(w[1], left / d);
        }
        left -= d;
    }
    line.first().copied().unwrap_or(DVec2::ZERO)
}

/// Cuts triangles off a polygon that is given counter-clockwise by the indices of its corners.
fn ears(points: &[DVec2], mut polygon: Vec<usize>, out: &mut Vec<[u32; 3]>) -> Option<()> {
    let twice = |a: usize, b: usize, c: usize| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    while polygon.len() > 2 {
        let n = polygon.len();
        let at = |k: usize| polygon[k % n];
        // The fattest ear first: slivers remain for the end, and few of them.
        let mut best: Option<(f64, usize)> = None;
        for k in 0..n {
            let (a, b, c) = (at(k), at(k + 1), at(k + 2));
            let area = twice(a, b, c);
            let holds = |&p: &usize| {
                p != a
                    && p != b
                    && p != c
                    && twice(a, b, p) >= 0.0
                    && twice(b, c, p) >= 0.0
                    && twice(c, a, p) >= 0.0
            };
            if area > 0.0 && !polygon.iter().any(holds) {
                let around = [(a, b), (b, c), (c, a)].map(|(p, q)| points[p].distance_squared(points[q]));
                let fat = area / around.into_iter().sum::<f64>().max(f64::MIN_POSITIVE);
                if best.is_none_or(|(most, _)| fat > most) {
                    best = Some((fat, (k + 1) % n));
                }
            }
        }
        let Some((_, k)) = best else {
            // The rest has no area, for example on a straight margin.
            let area: f64 = (0..n).map(|k| points[at(k)].perp_dot(points[at(k + 1)])).sum();
            let around: f64 = (0..n).map(|k| points[at(k)].distance_squared(points[at(k + 1)])).sum();
            return (area.abs() < 1e-9 * around).then_some(());
        };
        out.push([at(k + n - 1), at(k), at(k + 1)].map(crate::sleeve::index));
        polygon.remove(k);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use plant::{Lift, Relief};

    fn blade(right: &[(f64, f64)]) -> Blade {
        let right: Vec<DVec2> = right.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        let mut outline = vec![DVec2::ZERO];
        outline.extend(&right);
        outline.push(DVec2::Y);
        outline.extend(right.iter().rev().map(|p| DVec2::new(-p.x, p.y)));
        let midrib = vec![DVec2::ZERO, DVec2::Y];
        Blade {
            outline,
            midrib,
            veins: vec![],
            needles: None,
            lift: Lift::Flat,
            relief: Relief { fold: 0.3, ..Relief::default() },
        }
    }

    #[test]
    fn lobes_outlive_curves_and_nothing_of_the_area_is_lost() {
        let star = blade(&[(0.3, 0.05), (0.12, 0.25), (0.4, 0.4), (0.14, 0.55), (0.3, 0.8), (0.29, 0.81)]);
        for (wish, at_most) in [(4.0, 4), (8.0, 8), (12.0, 12), (40.0, 14)] {
            let mesh = lean_mesh(&star, wish, COPIED_WIDER).expect("a simple outline");
            assert_eq!(mesh.validate().next(), None, "{wish}");
            assert!(mesh.triangles.len() <= at_most && mesh.triangles.len() + 2 >= at_most, "{wish}");
        }
        let mesh = lean_mesh(&star, 12.0, COPIED_WIDER).expect("a simple outline");
        let flat = |i: u32| {
            DVec2::new(f64::from(mesh.positions[i as usize][0]), f64::from(mesh.positions[i as usize][1]))
        };
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|t| 0.5 * (flat(t[1]) - flat(t[0])).perp_dot(flat(t[2]) - flat(t[0])))
            .sum();
        let whole = geom::signed_area(&star.outline);
        assert!((area / whole - 1.0).abs() < 0.05, "{area} of {whole}");
    }

    /// Like a fig's.
    #[test]
    fn deep_lobes_are_no_spikes() {
        let fingers = blade(&[(0.5, 0.1), (0.52, 0.15), (0.06, 0.3), (0.45, 0.6), (0.43, 0.66), (0.05, 0.5)]);
        for wish in [2.0, 4.0, 6.0] {
            let mesh = lean_mesh(&fingers, wish, COPIED_WIDER).expect("a simple outline");
            let wide = mesh.positions.iter().map(|p| f64::from(p[0].abs())).fold(0.0, f64::max);
            assert!(wide <= WIDE * half_width(&fingers.outline), "{wish}: {wide}");
        }
    }

    /// Like a maple's of a coarser copy.
    #[test]
    fn four_triangles_keep_three_lobes_and_the_bays_between() {
        let maple = blade(&[(0.15, -0.1), (0.6, 0.4), (0.18, 0.45)]);
        let mesh = lean_mesh(&maple, 4.0, COPIED_WIDER).expect("a simple outline");
        assert_eq!((mesh.validate().next(), mesh.triangles.len()), (None, 4));
        // Drawn wider and folded, but on its side and at its height.
        let drawn = |x: f64, y: f64| {
            let at = |p: &[f32; 3]| {
                (0.7..1.5).contains(&(f64::from(p[0]) / x)) && (f64::from(p[1]) - y).abs() < 0.05
            };
            mesh.positions.iter().any(at)
        };
        for side in [-1.0, 1.0] {
            assert!(drawn(0.6 * side, 0.4) && drawn(0.18 * side, 0.45), "the tip of a lobe, and a bay");
        }
    }

    /// Like a leaflet of a far copy.
    #[test]
    fn a_blade_of_few_corners_is_drawn_as_it_is() {
        let corners = |corners: &[(f64, f64)]| Blade {
            outline: corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect(),
            relief: Relief::default(),
            ..blade(&[])
        };
        let kite = [(0.0, 0.0), (0.1, 0.2), (0.0, 1.0), (-0.1, 0.2)];
        for (outline, count) in [(&kite[..], 2), (&kite[1..], 1)] {
            let leaflet = corners(outline);
            let mesh = lean_mesh(&leaflet, 60.0, COPIED_WIDER).expect("convex");
            assert_eq!((mesh.validate().next(), mesh.triangles.len()), (None, count));
            let at: Vec<DVec2> =
                (0..).take(mesh.positions.len()).map(|i| mesh.position(i).truncate()).collect();
            let near = |p: &DVec2| at.iter().any(|q| q.distance(*p) < 1e-6);
            assert!(leaflet.outline.iter().all(near), "{at:?}");
        }
        let backwards: Vec<_> = kite.iter().rev().copied().collect();
        let flawed = [kite[0], (f64::NAN, 0.2), kite[2]];
        assert!(few_corners(&corners(&backwards)).is_none() && few_corners(&corners(&flawed)).is_none());
    }

    /// Like a grass's.
    #[test]
    fn an_arched_blade_keeps_its_reach() {
        let mut grass = blade(&[(0.05, 0.2), (0.08, 0.5), (0.05, 0.8)]);
        grass.relief = Relief { bend_a: 0.15, bend_b: 0.45, keep_length: true, ..Relief::default() };
        let reach =
            |mesh: &TriMesh| mesh.positions.iter().map(|p| f64::from(p[1].hypot(p[2]))).fold(0.0, f64::max);
        let fine = reach(&crate::blade_mesh(&grass, 200.0));
        for wish in [4.0, 8.0, 12.0] {
            let mesh = lean_mesh(&grass, wish, COPIED_WIDER).expect("a simple outline");
            assert_eq!(mesh.validate().next(), None, "{wish}");
            assert!(mesh.triangles.len() as f64 <= wish && reach(&mesh) > 0.95 * fine, "{wish}");
        }
    }

    #[test]
    fn the_smallest_blade_is_two_triangles() {
        let mesh =
            lean_mesh(&blade(&[(0.2, 0.3), (0.3, 0.5), (0.1, 0.9)]), 2.0, COPIED_WIDER).expect("simple");
        assert_eq!(mesh.triangles.len(), 2);
        assert!(
            lean_mesh(&blade(&[(0.2, 0.9), (-0.2, 0.5), (0.2, 0.1)]), 8.0, COPIED_WIDER).is_none(),
            "it crosses itself"
        );
    }
}

//! Meshes discs, fruits, stamens and thorns in their own frames.

use base::ops;
use glam::{DVec2, DVec3};
use mesh::TriMesh;

use crate::sleeve::{Circle, drop_flat, narrow, narrow2, wide};
use crate::texture::{DISC_RADIUS, RECEPTACLE_AT, unevenness};
use crate::tube::{TubeSpec, tube};

/// Samples of a bent body's line for each given point: enough to look round.
const BENDS: usize = 4;

/// Columns of a mesh under construction.
#[derive(Default)]
struct Columns(TriMesh);

impl Columns {
    fn vertex(&mut self, p: DVec3, uv: (f64, f64)) -> u32 {
        self.0.uvs.push(narrow2(uv.0, uv.1));
        self.0.push(p)
    }

    /// Adds two triangles between columns `j` and `j + 1` of the rows that start at `a` and `b`.
    fn quad(&mut self, a: u32, b: u32, j: u32) {
        self.0.triangles.push([a + j, a + j + 1, b + j]);
        self.0.triangles.push([a + j + 1, b + j + 1, b + j]);
    }
}

/// Makes a disc: a dome of florets around +z, closed below by the receptacle. About `triangles` triangles.
pub(crate) fn dome(radius: f64, height: f64, triangles: f64) -> TriMesh {
    let sides = ops::whole((1.5 * triangles).sqrt().round().clamp(8.0, 64.0));
    let rows = (sides / 3).max(3);
    let circle = Circle::new(sides);
    let mut out = Columns::default();
    let at = |q: f64, (cos, sin): (f64, f64)| {
        // Florets are uneven; the rim keeps its place.
        let rough = 0.05 * radius * unevenness(q * cos, q * sin) * (1.0 - q * q);
        let swell = (1.0 - q * q).max(0.0).sqrt() * (1.0 - 0.18 * (1.0 - q) * (1.0 - q));
        DVec3::new(radius * q * cos, radius * q * sin, height * swell + rough)
    };
    let apex = out.vertex(at(0.0, (1.0, 0.0)), (0.5, 0.5));
    for k in 1..=rows {
        // Even steps of the angle: rows are denser at the rim, where the dome is steep.
        let q = ops::sin(ops::FRAC_PI_2 * f64::from(k) / f64::from(rows));
        for &(cos, sin) in &circle.0[..sides as usize] {
            out.vertex(at(q, (cos, sin)), (0.5 + DISC_RADIUS * q * cos, 0.5 - DISC_RADIUS * q * sin));
        }
    }
    let first = |k: u32| apex + 1 + (k - 1) * sides;
    for j in 0..sides {
        let next = (j + 1) % sides;
        out.0.triangles.push([apex, first(1) + j, first(1) + next]);
        for k in 1..rows {
            let (a, b) = (first(k), first(k + 1));
            out.0.triangles.push([a + j, b + j, b + next]);
            out.0.triangles.push([a + j, b + next, a + next]);
        }
    }
    // The receptacle: a shallow green cup below, with vertices of its own for the hard rim.
    let depth = 0.55 * height.abs().max(0.4 * radius);
    let rim = out.0.positions.len();
    for &corner in &circle.0[..sides as usize] {
        out.vertex(at(1.0, corner), RECEPTACLE_AT);
    }
    let cup = out.0.positions.len();
    for &(cos, sin) in &circle.0[..sides as usize] {
        out.vertex(DVec3::new(0.6 * radius * cos, 0.6 * radius * sin, -0.6 * depth), RECEPTACLE_AT);
    }
    let foot = out.vertex(DVec3::new(0.0, 0.0, -depth), RECEPTACLE_AT);
    let (rim, cup) = (crate::sleeve::index(rim), crate::sleeve::index(cup));
    for j in 0..sides {
        let next = (j + 1) % sides;
        out.0.triangles.push([rim + j, cup + j, rim + next]);
        out.0.triangles.push([cup + j, cup + next, rim + next]);
        out.0.triangles.push([cup + j, foot, cup + next]);
    }
    drop_flat(&mut out.0);
    out.0.compute_normals();
    out.0
}

/// Makes a body of revolution around +y; with `ribs` the skin is fluted, as in a cactus.
pub(crate) fn revolution(profile: &[DVec2], triangles: f64, ribs: u32) -> TriMesh {
    let line = generating_line(profile, triangles);
    if line.len() < 2 {
        return TriMesh::default();
    }
    #[expect(clippy::cast_precision_loss, reason = "a few dozen rows")]
    let rows = line.len() as f64;
    let sides = ops::whole((0.5 * triangles / rows).round().clamp(8.0, 64.0));
    let sides = if ribs > 0 { (4 * ribs).min(64) } else { sides };
    let circle = Circle::new(sides);
    let (low, high) = (line[0].y, line[line.len() - 1].y);
    let height = if (high - low).abs() > 0.0 { high - low } else { 1.0 };
    let mut out = Columns::default();
    let mut rows: Vec<u32> = Vec::with_capacity(line.len());
    for p in &line {
        rows.push(crate::sleeve::index(out.0.positions.len()));
        for (j, &(cos, sin)) in (0_u32..).zip(&circle.0) {
            let u = f64::from(j) / f64::from(sides);
            let flute =
                if ribs > 0 { 1.0 + 0.07 * (ops::cos(ops::TAU * f64::from(ribs) * u) - 1.0) } else { 1.0 };
            // +y is the axis: the angle runs from +z towards +x, so that rows wind outwards.
            let r = p.x * flute;
            out.vertex(DVec3::new(r * sin, p.y, r * cos), (u, (high - p.y) / height));
        }
    }
    for pair in rows.windows(2) {
        for j in 0..sides {
            out.quad(pair[0], pair[1], j);
        }
    }
    for (end, row) in [(line[0], rows[0]), (line[line.len() - 1], rows[rows.len() - 1])] {
        if end.x <= 0.0 {
            continue;
        }
        let lower = row == rows[0];
        let pole = out.vertex(DVec3::new(0.0, end.y, 0.0), (0.5, (high - end.y) / height));
        for j in 0..sides {
            let (a, b) = if lower { (row + j + 1, row + j) } else { (row + j, row + j + 1) };
            out.0.triangles.push([a, b, pole]);
        }
    }
    drop_flat(&mut out.0);
    smooth_seam(&mut out.0, &rows, sides);
    out.0
}

/// Makes a body along a line with a radius at each of its points, as [`revolution`] does about an axis.
pub(crate) fn bent(path: &[DVec3], radii: &[f64], triangles: f64, ribs: u32) -> TriMesh {
    let line = geom::catmull_rom(path, BENDS);
    let frames = geom::rotation_minimising_frames(&line, None);
    let mut way = Vec::with_capacity(frames.len());
    for (k, f) in frames.iter().enumerate() {
        let before = k.checked_sub(1).map_or(0.0, |i| way[i] + frames[i].origin.distance(f.origin));
        way.push(before);
    }
    if frames.len() < 2 || path.len() != radii.len() || (frames.len() - 1) != BENDS * (path.len() - 1) {
        return TriMesh::default();
    }
    let profile: Vec<DVec2> = radii.iter().enumerate().map(|(k, &r)| DVec2::new(r, way[BENDS * k])).collect();
    let mut mesh = revolution(&profile, triangles, ribs);
    let at = |y: f64| {
        let k = way.partition_point(|w| *w < y).clamp(1, frames.len() - 1);
        let t = (y - way[k - 1]) / (way[k] - way[k - 1]).max(f64::MIN_POSITIVE);
        let (a, b) = (&frames[k - 1], &frames[k]);
        let along = a.tangent.lerp(b.tangent, t).normalize_or(DVec3::Y);
        let side = a.normal.lerp(b.normal, t).reject_from(along).normalize_or_zero();
        // Right-handed, like x, y and z of the straight body.
        (a.origin.lerp(b.origin, t), side, along, side.cross(along))
    };
    for (p, n) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        let (straight, normal) = (wide(*p), wide(*n));
        let (origin, x, y, z) = at(straight.y);
        *p = narrow(origin + x * straight.x + z * straight.z);
        *n = narrow((x * normal.x + y * normal.y + z * normal.z).normalize_or(y));
    }
    mesh
}

/// Returns the profile, smooth and with few enough points; from the lower to the upper pole.
fn generating_line(profile: &[DVec2], triangles: f64) -> Vec<DVec2> {
    let mut points: Vec<DVec3> = Vec::with_capacity(profile.len());
    for p in profile.iter().filter(|p| p.is_finite()) {
        let q = DVec3::new(p.x.max(0.0), p.y, 0.0);
        if points.last() != Some(&q) {
            points.push(q);
        }
    }
    if points.len() < 2 {
        return Vec::new();
    }
    if points[0].y > points[points.len() - 1].y {
        points.reverse();
    }
    let rows = (0.3 * triangles).sqrt().clamp(4.0, 64.0);
    let smooth = geom::catmull_rom(&points, 6);
    let step = geom::polyline_length3(&smooth) / rows;
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    geom::resample3(&smooth, step).iter().map(|p| DVec2::new(p.x.max(0.0), p.y)).collect()
}

/// Computes smooth normals that agree along the seam and at the poles.
fn smooth_seam(mesh: &mut TriMesh, rows: &[u32], sides: u32) {
    mesh.compute_normals();
    for &row in rows {
        let (a, b) = (row as usize, (row + sides) as usize);
        let same = (1..sides as usize).all(|j| mesh.positions[a + j] == mesh.positions[a]);
        let n = if same {
            // A pole: every copy points along the axis.
            DVec3::Y * if row == rows[0] { -1.0 } else { 1.0 }
        } else {
            (wide(mesh.normals[a]) + wide(mesh.normals[b])).try_normalize().unwrap_or(DVec3::Y)
        };
        let range = if same { a..b + 1 } else { a..a + 1 };
        mesh.normals[range].fill(narrow(n));
        mesh.normals[b] = narrow(n);
    }
}

/// Makes a strand with a closed end and, for `knob > 0`, a ball at it. The texture's upper half (v below one half) is
/// the ball's, the lower half the strand's, its foot at v = 1; without a ball the whole texture is the strand's, its
/// foot at v = 0.
pub(crate) fn strand(path: &[DVec3], radii: &[f64], knob: f64, fine: bool) -> TriMesh {
    let (sides, rings) = if fine { (4, 4) } else { (4, 3) };
    let mut mesh = tube(path, radii, &TubeSpec { sides, rings, repeats: 1 });
    let most = mesh.uvs.iter().map(|uv| uv[1]).fold(f32::MIN_POSITIVE, f32::max);
    for uv in &mut mesh.uvs {
        let along = (uv[1] / most).clamp(0.0, 1.0);
        uv[1] = if knob > 0.0 { 1.0 - 0.5 * along } else { along };
    }
    if knob > 0.0 && !mesh.positions.is_empty() {
        let (Some(&end), before) = (path.last(), path.iter().rev().nth(1)) else { return mesh };
        let axis = before.and_then(|b| (end - *b).try_normalize()).unwrap_or(DVec3::Y);
        mesh.append(&ball(end, axis, knob, if fine { 6 } else { 4 }));
    }
    mesh
}

/// Makes a strand with six sides, a ring at each of its points and flat ends: the same triangles for any bend.
pub(crate) fn rod(path: &[DVec3], radii: &[f64]) -> TriMesh {
    const SIDES: u32 = 6;
    let mut out = Columns::default();
    let frames = geom::rotation_minimising_frames(path, None);
    let rings = frames.len().min(radii.len());
    if rings < 2 {
        return out.0;
    }
    let circle = Circle::new(SIDES);
    let mut first = Vec::with_capacity(rings);
    #[expect(clippy::cast_precision_loss, reason = "a few rings")]
    let along = |i: usize| 1.0 - i as f64 / (rings - 1) as f64;
    for (i, (f, r)) in frames.iter().zip(radii).enumerate() {
        first.push(crate::sleeve::index(out.0.positions.len()));
        for (j, &(cos, sin)) in (0_u32..).zip(&circle.0) {
            let p = f.origin + (f.normal * cos + f.binormal * sin) * *r;
            out.vertex(p, (f64::from(j) / f64::from(SIDES), along(i)));
        }
    }
    for pair in first.windows(2) {
        for j in 0..SIDES {
            out.quad(pair[0], pair[1], j);
        }
    }
    for (ring, i) in [(first[0], 0), (first[rings - 1], rings - 1)] {
        let middle = out.vertex(frames[i].origin, (0.5, along(i)));
        for j in 0..SIDES {
            let (a, b) = if i == 0 { (ring + j + 1, ring + j) } else { (ring + j, ring + j + 1) };
            out.0.triangles.push([middle, a, b]);
        }
    }
    smooth_seam(&mut out.0, &first, SIDES);
    out.0
}

/// Makes a strand of the fewest triangles: a closed prism of eight, from its first point to its last.
pub(crate) fn prism(path: &[DVec3], radii: &[f64]) -> TriMesh {
    let mut out = Columns::default();
    let (Some(&root), Some(&end)) = (path.first(), path.last()) else { return out.0 };
    let sound = |r: Option<&f64>| r.copied().filter(|r| r.is_finite() && *r > 0.0);
    let (Some(first), Some(last)) = (sound(radii.first()), sound(radii.last())) else { return out.0 };
    let Some(axis) = (end - root).try_normalize() else { return out.0 };
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let mut normals = Vec::with_capacity(6);
    for (centre, radius, v) in [(root, first, 1.0), (end, last, 0.0)] {
        for (&(cos, sin), u) in Circle::new(3).0[..3].iter().zip([0.0, 1.0 / 3.0, 2.0 / 3.0]) {
            let ray = across * cos + up * sin;
            out.vertex(centre + ray * radius, (u, v));
            normals.push(narrow(ray));
        }
    }
    for (j, k) in [(0, 1), (1, 2), (2, 0)] {
        out.0.triangles.extend([[j, k, j + 3], [k, k + 3, j + 3]]);
    }
    out.0.triangles.extend([[2, 1, 0], [3, 4, 5]]);
    out.0.normals = normals;
    drop_flat(&mut out.0);
    out.0
}

/// Makes a ball, slightly longer along its axis, for anthers and stigmas.
fn ball(centre: DVec3, axis: DVec3, radius: f64, sides: u32) -> TriMesh {
    let circle = Circle::new(sides);
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let rows = sides / 2;
    let mut out = Columns::default();
    let mut normals = Vec::new();
    let mut starts = Vec::new();
    for k in 0..=rows {
        let (sin, cos) = ops::sin_cos(ops::PI * f64::from(k) / f64::from(rows));
        starts.push(crate::sleeve::index(out.0.positions.len()));
        // The poles' sine is not quite 0 in floating point; their copies must coincide.
        let sin = if k == 0 || k == rows { 0.0 } else { sin };
        for (j, &(c, s)) in (0_u32..).zip(&circle.0) {
            let n = (across * c + up * s) * sin - axis * cos;
            normals.push(narrow(n.normalize_or(axis)));
            let p = centre + n * radius - axis * (cos * 0.35 * radius);
            let v = 0.02 + 0.46 * (1.0 - f64::from(k) / f64::from(rows));
            out.vertex(p, (f64::from(j) / f64::from(sides), v));
        }
    }
    for pair in starts.windows(2) {
        for j in 0..sides {
            out.quad(pair[0], pair[1], j);
        }
    }
    let mut mesh = out.0;
    mesh.normals = normals;
    drop_flat(&mut mesh);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bent_body_is_as_thick_as_a_straight_one() {
        let radius = |k: i32| 0.2 * ops::sin(ops::PI * f64::from(k) / 16.0).max(0.0).sqrt();
        let radii: Vec<f64> = (0..=16).map(|k| if k % 16 == 0 { 0.0 } else { radius(k) }).collect();
        let straight: Vec<DVec3> = (0..=16).map(|k| DVec3::Y * (f64::from(k) / 16.0)).collect();
        let profile: Vec<DVec2> = radii.iter().zip(&straight).map(|(r, p)| DVec2::new(*r, p.y)).collect();
        let (turned, along) = (revolution(&profile, 400.0, 0), bent(&straight, &radii, 400.0, 0));
        assert_eq!(turned.triangles, along.triangles);
        let solid = |mesh: &TriMesh| -> f64 {
            let corner =
                |&[a, b, c]: &[u32; 3]| mesh.position(a).dot(mesh.position(b).cross(mesh.position(c)));
            mesh.triangles.iter().map(corner).sum::<f64>() / 6.0
        };
        assert!((solid(&turned) - solid(&along)).abs() < 1e-6);
        // A third of a circle as long: by Pappus it has the same volume.
        let angle = |k: i32| 2.0 * ops::PI / 3.0 * f64::from(k) / 16.0;
        let arc: Vec<DVec3> = (0..=16)
            .map(|k| ops::sin_cos(angle(k)))
            .map(|(s, c)| DVec3::new(c, s, 0.0) * (1.5 / ops::PI))
            .collect();
        let mesh = bent(&arc, &radii, 400.0, 0);
        assert_eq!(mesh.validate().count(), 0);
        assert!((solid(&mesh) / solid(&turned) - 1.0).abs() < 0.02, "{}", solid(&mesh) / solid(&turned));
        let outwards = mesh.triangles.iter().all(|t| {
            let [a, b, c] = t.map(|i| mesh.position(i));
            (b - a).cross(c - a).dot(wide(mesh.normals[t[0] as usize])) > 0.0
        });
        assert!(outwards, "normals look out");
        assert!(bent(&[DVec3::ZERO; 3], &[0.1; 3], 400.0, 0).triangles.is_empty());
    }

    #[test]
    fn a_prism_is_closed_and_encloses_its_strand() {
        let path = [DVec3::ZERO, DVec3::new(0.1, 0.9, 0.3)];
        let mesh = prism(&path, &[0.01, 0.03]);
        assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.validate().count()), (6, 8, 0));
        let six: f64 = mesh
            .triangles
            .iter()
            .map(|&[a, b, c]| mesh.position(a).dot(mesh.position(b).cross(mesh.position(c))))
            .sum();
        // Between a third and all of the cone's volume: flat sides, and sides between unlike ends are not quite flat.
        let cone = path[1].length() / 3.0 * ops::PI * (0.01 * 0.01 + 0.01 * 0.03 + 0.03 * 0.03);
        assert!((0.33..1.0).contains(&(six / 6.0 / cone)), "{} of {cone}", six / 6.0);
        assert!(prism(&path, &[0.01, f64::NAN]).triangles.is_empty() && prism(&[], &[]).triangles.is_empty());
        assert!(prism(&[DVec3::ZERO; 2], &[0.1; 2]).triangles.is_empty());
    }
}

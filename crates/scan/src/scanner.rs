//! Meshes -> the cloud that a terrestrial laser scanner would measure, for trials with a known truth.

use base::{Draw, Seed, ops};
use glam::DVec3;
use mesh::{Model, TriMesh};
use plant::{AxisId, Plant};

/// A scanner at one position. Lengths in metres, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct ScannerSpec {
    /// Position of the scanner.
    pub position: DVec3,
    /// Angle between neighbouring beams. Default 0.63e-3: 6.3 mm at 10 m.
    pub step: f64,
    /// Width of a beam's footprint, as an angle, in addition to [`aperture_m`](Self::aperture_m). Default 0.3e-3.
    pub divergence: f64,
    /// Width of the beam where it leaves the scanner. Default 0.003.
    pub aperture_m: f64,
    /// Standard deviation of the range. Default 0.002.
    pub noise_m: f64,
    /// Surfaces nearer to one another along a beam are one echo, at the mean of their ranges: a mixed pixel. Default
    /// 0.25.
    pub pulse_m: f64,
    /// Greatest range; farther surfaces are not measured. Default 60.
    pub range_m: f64,
}

impl Default for ScannerSpec {
    fn default() -> Self {
        Self {
            position: DVec3::new(10.0, 1.6, 0.0),
            step: 0.63e-3,
            divergence: 0.3e-3,
            aperture_m: 0.003,
            noise_m: 0.002,
            pulse_m: 0.25,
            range_m: 60.0,
        }
    }
}

/// Number of rays along one side of a beam's footprint.
const ACROSS: usize = 3;
/// Number of rays that are traced at a time: a band of elevations.
const BAND: usize = 64;

/// Scans a model: returns the points, and for each the number of its part.
///
/// A beam is 9 rays over its footprint. Rays within [`pulse_m`](ScannerSpec::pulse_m) of its nearest hit form one
/// echo if they are three or more, else the next ones do. Cost: linear in beams and in the pixels of all triangles.
pub fn scan(model: &Model, spec: &ScannerSpec, seed: Seed) -> (Vec<DVec3>, Vec<u32>) {
    let mut s = seed.stream(Draw::Sampling);
    let boxes = facets(model, spec);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for f in &boxes {
        for k in 0..2 {
            low[k] = low[k].min(f.low[k]);
            high[k] = high[k].max(f.high[k]);
        }
    }
    if boxes.is_empty() {
        return (vec![], vec![]);
    }
    let count = |k: usize| index((high[k] - low[k]) / spec.step).min(1 << 15) + 1;
    let (columns, rows) = (count(0), count(1));
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    base::sort_by(&mut order, |&a, &b| boxes[a].low[1].total_cmp(&boxes[b].low[1]).then(a.cmp(&b)));
    let (mut points, mut parts) = (vec![], vec![]);
    let fine = spec.step / ACROSS as f64;
    let wide = columns * ACROSS;
    // The 3 x 3 rays of a beam lie over its footprint at the mean range, which may be narrower or wider than the
    // step.
    let mean = boxes.iter().map(|f| f.corner.length()).sum::<f64>() / boxes.len() as f64;
    let shrink = ((spec.divergence + spec.aperture_m / mean.max(0.1)) / spec.step).min(1.0);
    let turn = |origin: f64, i: usize| {
        let off = ((i % ACROSS) as f64 - 1.0) / ACROSS as f64;
        ops::sin_cos(origin + ((i / ACROSS) as f64 + 0.5 + off * shrink) * spec.step)
    };
    let across: Vec<(f64, f64)> = (0..wide).map(|i| turn(low[0], i)).collect();
    let mut active: Vec<usize> = vec![];
    let mut next = 0;
    for band in 0..rows.div_ceil(BAND) {
        let from = low[1] + (band * BAND) as f64 * spec.step;
        let to = from + BAND as f64 * spec.step;
        active.retain(|&f| boxes[f].high[1] >= from);
        while next < order.len() && boxes[order[next]].low[1] <= to {
            active.push(order[next]);
            next += 1;
        }
        let mut depth = vec![(f32::INFINITY, u32::MAX); wide * BAND * ACROSS];
        let up: Vec<(f64, f64)> = (0..BAND * ACROSS).map(|i| turn(from, i)).collect();
        for &f in &active {
            boxes[f].draw([low[0], from], fine, (&across, &up), &mut depth);
        }
        for row in 0..BAND {
            for column in 0..columns {
                let around =
                    |k: usize| depth[(row * ACROSS + k / ACROSS) * wide + column * ACROSS + k % ACROSS];
                let Some((range, part)) = echo(spec, around) else { continue };
                let azimuth = low[0] + (column as f64 + 0.5) * spec.step;
                let elevation = from + (row as f64 + 0.5) * spec.step;
                let range = range + spec.noise_m * s.normal();
                points.push(spec.position + beam(azimuth, elevation) * range);
                parts.push(part);
            }
        }
    }
    (points, parts)
}

/// Returns the wood of a plant with truly round sections, for trials: rings of 24 places whose polygon has the area
/// of their circle.
///
/// Meshes for viewing have fewer sides, inside the circle: a scanner would find them thinner.
pub fn wood_mesh(plant: &Plant) -> TriMesh {
    const SIDES: u32 = 24;
    let mut mesh = TriMesh::default();
    let turn = ops::TAU / f64::from(SIDES);
    let wider = (turn / ops::sin(turn)).sqrt();
    let mut first = 0_u32;
    for id in (0..plant.axes.len()).map(AxisId::new) {
        let (line, radii) = (plant.axis_points(id), plant.axis_radii(id));
        let frames = geom::rotation_minimising_frames(line, None);
        for ((p, r), f) in line.iter().zip(radii).zip(&frames) {
            for k in 0..SIDES {
                let (sin, cos) = ops::sin_cos(turn * f64::from(k));
                let q = *p + (f.normal * cos + f.binormal * sin) * (*r * wider);
                #[expect(clippy::cast_possible_truncation, reason = "a mesh")]
                mesh.positions.push([q.x as f32, q.y as f32, q.z as f32]);
            }
        }
        for _ in 1..line.len() {
            for k in 0..SIDES {
                let (a, b) = (first + k, first + (k + 1) % SIDES);
                mesh.triangles.push([a, b, b + SIDES]);
                mesh.triangles.push([a, b + SIDES, a + SIDES]);
            }
            first += SIDES;
        }
        mesh.triangles.extend((1..SIDES - 1).map(|k| [first, first + k, first + k + 1]));
        first += SIDES;
    }
    mesh
}

/// Returns the echo of a beam: mean range of the rays near the nearest hit that is strong enough, and the part that
/// most of them met.
fn echo(spec: &ScannerSpec, ray: impl Fn(usize) -> (f32, u32)) -> Option<(f64, u32)> {
    let mut hits: Vec<(f32, u32)> =
        (0..ACROSS * ACROSS).map(ray).filter(|h| f64::from(h.0) <= spec.range_m).collect();
    base::sort_by(&mut hits, |a, b| a.0.total_cmp(&b.0));
    while let Some(&(first, part)) = hits.first() {
        let same = hits.iter().take_while(|h| f64::from(h.0 - first) <= spec.pulse_m).count();
        if same >= 3 {
            let sum: f64 = hits[..same].iter().map(|h| f64::from(h.0)).sum();
            return Some((sum / same as f64, part));
        }
        hits.drain(..same);
    }
    None
}

fn beam(azimuth: f64, elevation: f64) -> DVec3 {
    let ((sa, ca), (se, ce)) = (ops::sin_cos(azimuth), ops::sin_cos(elevation));
    DVec3::new(ce * ca, se, ce * sa)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
const fn index(x: f64) -> usize {
    x as usize
}

/// Sine and cosine.
type Turn = (f64, f64);

/// A triangle in the scanner's view.
struct Facet {
    corner: DVec3,
    edges: [DVec3; 2],
    low: [f64; 2],
    high: [f64; 2],
    part: u32,
}

fn facets(model: &Model, spec: &ScannerSpec) -> Vec<Facet> {
    let parts = (0_u32..).zip(&model.parts);
    parts.flat_map(|(k, part)| triangles(&part.mesh).filter_map(move |t| Facet::new(t, spec, k))).collect()
}

fn triangles(mesh: &TriMesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    let at = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
    mesh.triangles.iter().map(move |t| t.map(at))
}

impl Facet {
    /// Returns none at the seam of azimuths: a triangle that spans more than a quarter of a turn.
    fn new(corners: [DVec3; 3], spec: &ScannerSpec, part: u32) -> Option<Self> {
        let c = corners.map(|p| p - spec.position);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in c {
            let flat = (p.x * p.x + p.z * p.z).sqrt();
            for (k, angle) in [ops::atan2(p.z, p.x), ops::atan2(p.y, flat)].into_iter().enumerate() {
                low[k] = low[k].min(angle);
                high[k] = high[k].max(angle);
            }
        }
        let near = c.iter().map(|p| p.length()).fold(f64::INFINITY, f64::min);
        let seen = high[0] - low[0] < ops::FRAC_PI_2 && near <= spec.range_m && near > 0.05;
        seen.then(|| Self { corner: c[0], edges: [c[1] - c[0], c[2] - c[0]], low, high, part })
    }

    /// Sets the rays of a band that meet it (Moeller and Trumbore 1997).
    fn draw(&self, origin: [f64; 2], fine: f64, (across, up): (&[Turn], &[Turn]), depth: &mut [(f32, u32)]) {
        let (wide, tall) = (across.len(), up.len());
        let first = |k: usize| index(((self.low[k] - origin[k]) / fine).max(0.0)).saturating_sub(ACROSS);
        let last = |k: usize, n: usize| (index(((self.high[k] - origin[k]) / fine).max(0.0)) + ACROSS).min(n);
        let [e1, e2] = self.edges;
        for row in first(1)..last(1, tall) {
            let (se, ce) = up[row];
            for column in first(0)..last(0, wide) {
                let (sa, ca) = across[column];
                let d = DVec3::new(ce * ca, se, ce * sa);
                let p = d.cross(e2);
                let det = e1.dot(p);
                if det.abs() < 1e-15 {
                    continue;
                }
                let s = -self.corner;
                let u = s.dot(p) / det;
                let q = s.cross(e1);
                let v = d.dot(q) / det;
                if u < 0.0 || v < 0.0 || u + v > 1.0 {
                    continue;
                }
                let t = e2.dot(q) / det;
                let slot = &mut depth[row * wide + column];
                #[expect(clippy::cast_possible_truncation, reason = "single precision is a micrometre here")]
                if t > 0.05 && (t as f32) < slot.0 {
                    *slot = (t as f32, self.part);
                }
            }
        }
    }
}

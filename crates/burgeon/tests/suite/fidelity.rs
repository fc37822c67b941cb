//! The reported fidelity compared with an oracle that uses pictures: the model's meshes, seen from the front, as masks
//! of pixels, and the ink as a mask of pixels.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    clippy::print_stdout,
    reason = "pixels of a small picture; what they measure is told"
)]

use crate::missing;
use std::path::{Path, PathBuf};

use burgeon::formats::{DrawingFormat, read_drawings};
use burgeon::geom::{self, KdTree2};
use burgeon::glam::DVec2;
use burgeon::ink::{self, Drawing, Ink};
use burgeon::plant::{AxisId, Organ, OrganKind, Plant, ShapeId};
use burgeon::reading::{self, OrganWord, Reading};
use burgeon::sketch::{self, Built, Fidelity, SketchSpec};
use burgeon::{Report, Run, Seed, skin};

/// Pixels along the drawing's diagonal.
const PIXELS: f64 = 800.0;
/// Empty pixels around the drawing.
const MARGIN: f64 = 120.0;
/// Side of the picture, pixels.
const SIDE: usize = 1040;

/// A square picture whose pixels are set or not.
#[derive(Clone)]
struct Mask(Vec<bool>);

impl Mask {
    fn new() -> Self {
        Self(vec![false; SIDE * SIDE])
    }

    fn polygon(ring: &[DVec2]) -> Self {
        let inside = geom::Inside::new(ring);
        Self((0..SIDE * SIDE).map(|i| inside.has(centre(i))).collect())
    }

    fn add(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a |= b);
    }

    fn dot(&mut self, p: DVec2) {
        let q = p * PIXELS + MARGIN;
        if q.min_element() >= 0.0 && q.max_element() < SIDE as f64 {
            self.0[q.y as usize * SIDE + q.x as usize] = true;
        }
    }

    fn line(&mut self, a: DVec2, b: DVec2) {
        let n = (a.distance(b) * PIXELS * 2.0).ceil().max(1.0) as usize;
        (0..=n).for_each(|k| self.dot(a.lerp(b, k as f64 / n as f64)));
    }

    /// Sets the pixels whose middle is inside, and those on the edges.
    fn triangle(&mut self, t: [DVec2; 3]) {
        (0..3).for_each(|i| self.line(t[i], t[(i + 1) % 3]));
        let pixel = |p: DVec2| p * PIXELS + MARGIN;
        let low = pixel(t[0].min(t[1]).min(t[2])).max(DVec2::ZERO);
        let high = pixel(t[0].max(t[1]).max(t[2])).min(DVec2::splat(SIDE as f64 - 1.0));
        for y in low.y as usize..=high.y.max(0.0) as usize {
            for x in low.x as usize..=high.x.max(0.0) as usize {
                let p = centre(y * SIDE + x);
                let side = |i: usize| (t[(i + 1) % 3] - t[i]).perp_dot(p - t[i]);
                let (a, b, c) = (side(0), side(1), side(2));
                if (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0) {
                    self.0[y * SIDE + x] = true;
                }
            }
        }
    }

    fn points(&self) -> Vec<DVec2> {
        (0..self.0.len()).filter(|&i| self.0[i]).map(centre).collect()
    }

    /// Returns set pixels with a neighbour that is not set.
    fn rim(&self) -> Vec<DVec2> {
        let inner = |i: usize| [1, SIDE].iter().all(|d| self.0[i - d] && self.0[(i + d) % self.0.len()]);
        (SIDE..self.0.len()).filter(|&i| self.0[i] && !inner(i)).map(centre).collect()
    }

    /// Keeps set pixels whose neighbours up to three away are all set.
    fn inner(&self) -> Self {
        let reach = 3 * (SIDE + 1);
        let square = |i: usize| (0..7).flat_map(move |y| (0..7).map(move |x| i + y * SIDE + x - reach));
        let inner = |i: usize| self.0[i] && square(i).all(|k| self.0[k]);
        Self((0..self.0.len()).map(|i| i >= reach && i + reach < self.0.len() && inner(i)).collect())
    }

    /// Sets each pixel within `radius` of a set one.
    fn grown(&self, radius: f64) -> Self {
        let tree = KdTree2::new(&self.points());
        Self((0..self.0.len()).map(|i| self.0[i] || tree.nearest(centre(i), radius).is_some()).collect())
    }

    fn inverse(&self) -> Self {
        Self(self.0.iter().map(|b| !b).collect())
    }
}

fn centre(i: usize) -> DVec2 {
    (DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) + 0.5 - MARGIN) / PIXELS
}

/// One drawing, understood and built.
struct Case {
    ink: Ink,
    reading: Reading,
    built: Built,
    said: Fidelity,
}

fn case(drawing: &Drawing) -> Case {
    let (run, mut report) = (Run::plain(), Report::default());
    let ink = ink::clean(drawing, &mut report);
    let classes = ink::classify(&ink, &run);
    let reading = reading::read(&ink, &classes, &mut report);
    let spec = SketchSpec::default();
    let built = sketch::build(&reading, &spec, Seed::new(1), &run, &mut report).expect("not cancelled");
    let said = sketch::fidelity(&built, &reading, &ink, &run).expect("not cancelled");
    Case { ink, reading, built, said }
}

/// Figures from pictures: mean distance from ink to model, from model to ink, and overlap of contours.
#[derive(Debug)]
struct Seen {
    reprojection: Option<f64>,
    excess: Option<f64>,
    overlap: Option<f64>,
}

impl Case {
    fn seen(&self) -> Seen {
        let contours = self.contours();
        let (mut features, mut outlines) = (Vec::new(), Vec::new());
        let mut within = Mask::new();
        for (mask, outline) in self.shown() {
            let rim = mask.rim();
            within.add(&mask.inner());
            if outline {
                outlines.extend(rim.iter().copied());
            }
            features.extend(rim);
        }
        let ignored: Vec<u32> = self
            .reading
            .strokes
            .iter()
            .filter(|s| matches!(s.organ, OrganWord::Ignored | OrganWord::Pot))
            .map(|s| s.index)
            .collect();
        let filled: Vec<u32> = (self.reading.strokes.iter())
            .filter(|s| matches!(s.organ, OrganWord::LeafContour | OrganWord::TwigContour))
            .map(|s| s.index)
            .chain(self.reading.regions.iter().filter_map(|r| r.source))
            .collect();
        let near_contour = contours.grown(0.012);
        let (mut all, mut drawn) = (Mask::new(), Vec::new());
        for stroke in &self.ink.strokes {
            let mut own = Mask::new();
            stroke.raw.windows(2).for_each(|w| own.line(w[0], w[1]));
            all.add(&own);
            if ignored.contains(&stroke.index) {
                continue;
            }
            let by_area = filled.contains(&stroke.index);
            let pixels = (0..own.0.len()).filter(|&i| own.0[i] && !(by_area && near_contour.0[i]));
            // Veins within a blade have no rim.
            drawn.extend(pixels.filter(|&i| !within.0[i]).map(centre));
        }
        outlines.retain(|&p| !contours.0[index(p)]);
        Seen {
            reprojection: mean_distance(&drawn, &features),
            excess: mean_distance(&outlines, &all.points()),
            overlap: self.overlap(&contours),
        }
    }

    fn contours(&self) -> Mask {
        let mut mask = Mask::new();
        for grown in &self.built.grown {
            let ring: Vec<DVec2> = grown.outline.iter().map(|&p| self.built.map.ink_from_plant(p)).collect();
            mask.add(&Mask::polygon(&ring));
        }
        mask
    }

    /// Returns masks of the parts that did not grow in contours, each by itself, and whether it is more than a detail.
    fn shown(&self) -> Vec<(Mask, bool)> {
        let plant = &self.built.plant;
        let grown_axis = |i: usize| self.built.grown.iter().any(|g| g.axes.contains(&i));
        let grown_organ = |i: usize| self.built.grown.iter().any(|g| g.organs.contains(&i));
        let mut masks = Vec::new();
        for i in (0..plant.axes.len()).filter(|&i| !grown_axis(i)) {
            let axis = &plant.axes[i];
            let thick = self.reading.axes.iter().any(|a| a.source == axis.source && !a.half_width.is_empty());
            let mut alone = Plant::default();
            let points = plant.axis_points(AxisId::new(i)).to_vec();
            alone.add_axis(axis.kind, None, 1, &points, None);
            // A line stands for its middle.
            let share = if thick && axis.source.is_some() { 1.0 } else { 0.02 };
            alone.nodes.radius_m = plant.axis_radii(AxisId::new(i)).iter().map(|r| r * share).collect();
            masks.push((self.mask(&alone), true));
        }
        // Pots are smoothed, and compared with nothing.
        let compared = |(i, o): &(usize, &Organ)| !grown_organ(*i) && o.kind != OrganKind::Pot;
        for (_, organ) in plant.organs.iter().enumerate().filter(compared) {
            let alone = Plant {
                shapes: vec![plant.shapes[organ.shape.index()].clone()],
                organs: vec![Organ { shape: ShapeId::new(0), bearer: None, flower: None, ..organ.clone() }],
                ..Plant::default()
            };
            let detail = matches!(organ.kind, OrganKind::Stamen | OrganKind::Pistil);
            masks.push((self.mask(&alone), !detail));
        }
        masks
    }

    /// Returns a plant's meshes from the front.
    fn mask(&self, plant: &Plant) -> Mask {
        let mut mask = Mask::new();
        let spec = skin::SkinSpec::default();
        let Ok(model) = skin::skin(plant, &spec, &Run::plain()) else { return mask };
        for part in &model.parts {
            for t in &part.mesh.triangles {
                mask.triangle(t.map(|i| self.built.map.ink_from_plant(part.mesh.position(i).truncate())));
            }
        }
        mask
    }

    fn overlap(&self, contours: &Mask) -> Option<f64> {
        if self.built.grown.is_empty() {
            return None;
        }
        let plant = &self.built.plant;
        let mut covered = Mask::new();
        for grown in &self.built.grown {
            let leaves = Plant {
                shapes: plant.shapes.clone(),
                organs: plant.organs[grown.organs.clone()]
                    .iter()
                    .map(|o| Organ { bearer: None, ..o.clone() })
                    .collect(),
                ..Plant::default()
            };
            let mut alone = self.mask(&leaves);
            for axis in grown.axes.clone() {
                let seen = |k: usize| {
                    self.built.map.ink_from_plant(plant.axis_points(AxisId::new(axis))[k].truncate())
                };
                (1..plant.axis_points(AxisId::new(axis)).len())
                    .for_each(|k| alone.line(seen(k - 1), seen(k)));
            }
            let ring: Vec<DVec2> = grown.outline.iter().map(|&p| self.built.map.ink_from_plant(p)).collect();
            let inside = Mask::polygon(&ring);
            let rims = inside.inverse().rim();
            let outside = KdTree2::new(&rims);
            let inradius = (inside.points().iter().step_by(7))
                .filter_map(|&p| Some(rims[outside.nearest(p, 2.0)?].distance(p)))
                .fold(0.0, f64::max);
            let gap = inradius * if grown.kind == reading::RegionKind::Twigs { 0.5 } else { 0.125 };
            let closed = alone.grown(gap).inverse().grown(gap).inverse();
            covered.add(&closed);
        }
        let count = |f: &dyn Fn(bool, bool) -> bool| {
            contours.0.iter().zip(&covered.0).filter(|(a, b)| f(**a, **b)).count() as f64
        };
        Some(count(&|a, b| a && b) / count(&|a, b| a || b).max(1.0))
    }
}

fn index(p: DVec2) -> usize {
    let q = p * PIXELS + MARGIN;
    q.y as usize * SIDE + q.x as usize
}

fn mean_distance(from: &[DVec2], to: &[DVec2]) -> Option<f64> {
    let tree = KdTree2::new(to);
    let distances: Vec<f64> =
        from.iter().filter_map(|&p| Some(to[tree.nearest(p, f64::INFINITY)?].distance(p))).collect();
    (!distances.is_empty()).then(|| distances.iter().sum::<f64>() / distances.len() as f64)
}

fn fixtures() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/sketches");
    let mut all = Vec::new();
    for folder in ["table1", "gallery"] {
        let entries = std::fs::read_dir(root.join(folder)).expect("fixtures");
        all.extend(entries.map(|e| e.expect("a file").path()));
    }
    all.sort();
    all
}

fn drawings(path: &Path, format: DrawingFormat) -> Vec<Drawing> {
    let bytes = std::fs::read(path).expect("a file");
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    read_drawings(bytes.as_slice(), format, &name).filter_map(Result::ok).map(|d| d.drawing).collect()
}

/// Largest difference between `said` and `seen`, in shares of the diagonal: three pixels.
const SAME: f64 = 3.0 / PIXELS;

/// The same for drawings by people, which overlap and leave gaps: their regions are uncertain by a few pixels more.
const SAME_BY_HAND: f64 = 0.01;

fn percent(x: Option<f64>) -> String {
    x.map_or_else(|| "-".to_owned(), |x| format!("{:.2}", 100.0 * x))
}

/// Prints a row and returns whether figures and pictures agree, distances within `same`.
fn agrees(name: &str, case: &Case, same: f64) -> bool {
    let seen = case.seen();
    let said = &case.said;
    println!(
        "{name:24} ink {:>6} {:>6}  model {:>6} {:>6}  overlap {:>6} {:>6}  compared {:.2}",
        percent(said.reprojection_mean),
        percent(seen.reprojection),
        percent(said.excess_mean),
        percent(seen.excess),
        percent(said.overlap),
        percent(seen.overlap),
        said.compared,
    );
    let near = |a: Option<f64>, b: Option<f64>, most: f64| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= most,
        (a, b) => a.is_none() && b.is_none(),
    };
    // A picture of a trunk that was drawn as an outline also shows its foot and its edges in the crown, which nobody
    // draws and the figure leaves out.
    let trunk = case.reading.axes.iter().any(|a| !a.half_width.is_empty());
    near(said.reprojection_mean, seen.reprojection, same)
        && (trunk || near(said.excess_mean, seen.excess, same))
        && near(said.overlap, seen.overlap, 0.08)
}

#[test]
fn fixtures_are_as_true_as_the_report_says() {
    println!("percent of the diagonal, or of the area: said, seen");
    let mut wrong = Vec::new();
    for path in fixtures() {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for drawing in drawings(&path, DrawingFormat::Svg) {
            if !agrees(&name, &case(&drawing), SAME) {
                wrong.push(name.clone());
            }
        }
    }
    assert!(wrong.is_empty(), "said and seen differ: {wrong:?}");
}

#[test]
fn drawings_with_times_are_as_true_as_the_report_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/ndjson/raw.ndjson");
    let drawings = drawings(&path, DrawingFormat::Ndjson);
    assert_eq!(drawings.len(), 6);
    let wrong: Vec<usize> =
        (0..6).filter(|&i| !agrees(&format!("raw {i}"), &case(&drawings[i]), SAME_BY_HAND)).collect();
    assert!(wrong.is_empty(), "said and seen differ: {wrong:?}");
}

#[test]
fn drawings_of_people_are_as_true_as_the_report_says() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/sketches/quickdraw");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        return missing::skipped(folder.display());
    };
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.sort();
    let mut wrong = Vec::new();
    for path in files.iter().filter(|p| p.extension().is_some_and(|e| e == "ndjson")) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for (i, drawing) in drawings(path, DrawingFormat::Ndjson).iter().enumerate().step_by(20) {
            let name = format!("{name} {i}");
            if !agrees(&name, &case(drawing), SAME_BY_HAND) {
                wrong.push(name);
            }
        }
    }
    assert!(wrong.is_empty(), "said and seen differ: {wrong:?}");
}

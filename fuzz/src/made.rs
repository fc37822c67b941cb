//! Steps after the readers: drawings cleaned, read, built and measured; edits; copies; growth laws; scans of several
//! days.

use std::sync::OnceLock;

use burgeon::bloom::{
    self, BloomError, GrowthLaw, LawSpec, Motion, MotionSpec, Offset, RegisterSpec, ScanOrgan, Series, Stage,
};
use burgeon::formats::{GrowthSpec, read_growth};
use burgeon::glam::{DVec2, DVec3};
use burgeon::ink::{self, Drawing, Stroke, StrokeMode};
use burgeon::plant::Plant;
use burgeon::shape::{AxisKey, Context, Destination, EditsFile, HandEdit, Mirror, Outcome, apply};
use burgeon::sketch::SketchSpec;
use burgeon::skin::SkinSpec;
use burgeon::{
    Budget, Counted, Evaluator, Report, Run, Seed, SketchOptions, Stopped, TreeOptions, make_tree,
    read_tree_spec, reading as readings, sketch,
};

use super::asked::{assert_model, assert_plant};
use super::refused;

/// Limits of the part of an input that is used: a mutant of a few thousand bytes never takes minutes.
struct Bounds {
    /// Strokes of a drawing.
    strokes: usize,
    /// Points of all strokes.
    points: usize,
    /// Most strokes of a drawing that is also made stroke by stroke, which must give the same.
    grown_strokes: usize,
    /// Edits of a file.
    edits: usize,
    /// Copies of branches: each may double the plant.
    copies: usize,
    /// Rows of a growth table.
    rows: usize,
    /// Days of a series of scans.
    stages: usize,
    /// Organs of a scan.
    organs: usize,
    /// Points of an organ.
    organ_points: usize,
}

/// Limits for mutants; the large drawings of the test `kept` have a separate entry.
const BOUNDS: Bounds = Bounds {
    strokes: 1_000,
    points: 30_000,
    grown_strokes: 12,
    edits: 40,
    copies: 30,
    rows: 3_000,
    stages: 5,
    organs: 4,
    organ_points: 200,
};

/// Makes a drawing: one stroke in each line, as `x y x y ...`, with `branch-contour`, `leaf-contour` or `#rrggbb` if it
/// has one.
///
/// Cleaned, classified, read, built and measured. Each step is sound whatever the one before it was; a drawing that
/// grew stroke by stroke gives the same plant as the whole at once.
pub fn reading(bytes: &[u8]) -> bool {
    let drawing = drawn(&String::from_utf8_lossy(bytes));
    let run = Run { budget: Budget { times: 0.1, ..Budget::default() }, ..Run::plain() };
    let mut report = Report::default();
    let ink = ink::clean(&drawing, &mut report);
    let within = |p: &DVec2| {
        p.is_finite() && p.cmpge(DVec2::splat(-1e-9)).all() && p.cmple(DVec2::splat(1.0 + 1e-9)).all()
    };
    assert!(ink.strokes.iter().flat_map(|s| &s.points).all(within), "ink lies within its box");
    assert!(ink.strokes.iter().all(|s| s.length > 0.0 && s.points.len() >= 2), "strokes have a length");
    assert!(ink.strokes.len() + ink.skipped.len() <= drawing.strokes.len(), "no stroke comes twice");
    let classes = ink::classify(&ink, &run);
    assert_eq!(classes.len(), ink.strokes.len(), "a class for each stroke");
    let read = readings::read(&ink, &classes, &mut report);
    assert_eq!(read.validate().next(), None, "a sound reading");
    let built = sketch::build(&read, &SketchSpec::default(), Seed::new(1), &run, &mut report);
    let built = built.expect("nobody cancels");
    assert_plant(&built.plant);
    let found = sketch::fidelity(&built, &read, &ink, &run).expect("nobody cancels");
    let distances = [found.reprojection_mean, found.reprojection_p95, found.excess_mean, found.excess_p95];
    assert!(distances.iter().flatten().all(|d| d.is_finite() && *d >= 0.0), "distances: {found:?}");
    assert!((0.0..=1.0).contains(&found.compared), "a share: {}", found.compared);
    assert!(found.overlap.is_none_or(|o| (0.0..=1.0 + 1e-9).contains(&o)), "a share: {:?}", found.overlap);
    let options = SketchOptions {
        skin: SkinSpec { textures: false, ..SkinSpec::default() },
        ..SketchOptions::default()
    };
    let mut whole = Evaluator::default();
    let at_once = match whole.update(&drawing, &options, Seed::new(1), &run) {
        Ok(item) => item,
        Err(e) => return refused(&e),
    };
    assert!(!ink.strokes.is_empty(), "made of nothing");
    if drawing.strokes.len() <= BOUNDS.grown_strokes {
        let mut growing = Evaluator::default();
        let mut last = None;
        for upto in 1..=drawing.strokes.len() {
            let part = Drawing { strokes: drawing.strokes[..upto].to_vec(), ..drawing.clone() };
            last = growing.update(&part, &options, Seed::new(1), &run).ok();
        }
        let last = last.expect("the whole was made at once");
        assert_eq!(last.digest, at_once.digest, "stroke by stroke it is another plant");
    }
    true
}

/// Parses the drawing of a text of `reading`.
fn drawn(text: &str) -> Drawing {
    let mut drawing = Drawing { name: "fuzz".into(), ..Drawing::default() };
    let mut points_left = BOUNDS.points;
    for line in text.lines().take(BOUNDS.strokes) {
        let (mut mode, mut color, mut numbers) = (StrokeMode::default(), None, Vec::new());
        for word in line.split_whitespace() {
            if word == "branch-contour" {
                mode = StrokeMode::BranchContour;
            } else if word == "leaf-contour" {
                mode = StrokeMode::LeafContour;
            } else if let Some(hex) = word.strip_prefix('#').and_then(|h| u32::from_str_radix(h, 16).ok()) {
                let [_, r, g, b] = hex.to_be_bytes();
                color = Some([r, g, b]);
            } else if let Ok(number) = word.parse::<f64>() {
                numbers.push(number);
            }
        }
        numbers.truncate(2 * points_left);
        points_left -= numbers.len() / 2;
        let points = numbers.chunks_exact(2).map(|p| DVec2::new(p[0], p[1]));
        let samples = points.map(ink::InkSample::from).collect();
        drawing.strokes.push(Stroke { samples, mode, color, ..Stroke::default() });
    }
    drawing
}

/// Returns a small tree with leaves, made once.
pub(super) fn tree() -> &'static Plant {
    static TREE: OnceLock<Plant> = OnceLock::new();
    TREE.get_or_init(|| {
        let spec = read_tree_spec(BUSH, &|_| None).expect("a spec of our own");
        make_tree(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("grows").grown.plant
    })
}

/// The spec of [`tree`].
pub(super) const BUSH: &str = "name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 200\nlifespan = 1\n[leaves]\nspacing_m = 0.3\n";

/// Applies a file of edits to a small tree: each is done, or refused with a reason, and the plant is sound.
pub fn edits(bytes: &[u8]) -> bool {
    let Ok(file) = serde_json::from_slice::<EditsFile>(bytes) else { return false };
    let edits = &file.edits[..file.edits.len().min(BOUNDS.edits)];
    let run = Run { budget: Budget { times: 0.01, ..Budget::default() }, ..Run::plain() };
    let applied = match apply(tree(), edits, &Context::default(), &run) {
        Ok(applied) => applied,
        Err(e) => return refused(&e),
    };
    assert_plant(&applied.plant);
    assert_meshes(&applied.plant, &run);
    assert_eq!(applied.outcomes.len(), edits.len(), "an outcome for each edit");
    for (edit, outcome) in edits.iter().zip(&applied.outcomes) {
        refused(&outcome_words(outcome));
        assert!(edit.check().is_ok() || !outcome.is_done(), "done with a number that is none: {edit:?}");
    }
    if applied.outcomes.iter().all(|o| !o.is_done()) {
        assert!(applied.plant == *tree(), "what was not done changes nothing");
    }
    let again: EditsFile =
        serde_json::from_value(serde_json::to_value(&file).expect("JSON")).expect("reads what it wrote");
    assert_eq!(again, file, "a file of edits is the same after it was written");
    applied.outcomes.iter().any(Outcome::is_done)
}

fn outcome_words(outcome: &Outcome) -> String {
    if outcome.is_done() { "it was done".into() } else { outcome.to_string() }
}

/// Makes copies of copies: each three bytes are a branch, its destination, and the place on it. The pieces stay within
/// the budget.
pub fn copies(bytes: &[u8]) -> bool {
    let branch = |byte: u8| {
        let path = [0, u32::from(byte >> 4), u32::from(byte & 15)];
        AxisKey::Path(path[..1 + usize::from(byte % 3)].to_vec())
    };
    let edits: Vec<HandEdit> = bytes
        .chunks_exact(3)
        .take(BOUNDS.copies)
        .map(|c| {
            let share = f64::from(c[2]) / 255.0;
            if c[0] == 255 {
                let mirror = Some(Mirror { point: DVec3::ZERO, normal: DVec3::new(share, 0.0, 1.0 - share) });
                let points = vec![DVec3::new(0.0, share, 0.0), DVec3::new(share, 1.0, 0.5)];
                return HandEdit::SketchBranch {
                    bearer: branch(c[1]),
                    at: None,
                    points,
                    twigs: 1.0,
                    seed: 1,
                    mirror,
                };
            }
            HandEdit::Copy { axis: branch(c[0]), to: Destination::Place { axis: branch(c[1]), at: share } }
        })
        .collect();
    let own = pieces(tree());
    let budget = Budget { times: 0.02, ..Budget::default() };
    let limit = budget.limit(Counted::Pieces);
    assert!(own < limit, "the tree itself is small: {own}");
    match apply(tree(), &edits, &Context::default(), &Run { budget, ..Run::plain() }) {
        Ok(applied) => {
            assert_plant(&applied.plant);
            // Sketched branches are small, and bear twigs; only copies are counted before they are made.
            let sketched = edits.iter().filter(|e| matches!(e, HandEdit::SketchBranch { .. })).count() as u64;
            let made = pieces(&applied.plant);
            assert!(made <= limit + 1_000 * sketched, "{made} pieces, {limit} are allowed");
            applied.outcomes.iter().any(Outcome::is_done)
        }
        Err(Stopped::OverBudget(over)) => {
            assert!(over.number > over.limit, "refused for nothing: {over}");
            refused(&over)
        }
        Err(Stopped::Cancelled(e)) => panic!("nobody cancels: {e}"),
    }
}

/// Counts nodes, leaves and flowers.
fn pieces(plant: &Plant) -> u64 {
    (plant.nodes.position.len() + plant.organs.len() + plant.flowers.len()) as u64
}

/// Reads a growth law or a growth table: laws are fitted, and a flower that follows one is sound on every day.
pub fn law_after(bytes: &[u8]) -> bool {
    let law = match serde_json::from_slice::<GrowthLaw>(bytes) {
        Ok(law) => law,
        Err(_) => {
            let Some(law) = fitted(bytes) else { return false };
            assert_eq!(law.validate().next(), None, "what was fitted is sound");
            law
        }
    };
    if law.validate().next().is_some() {
        return false;
    }
    let checks = burgeon::check_law(&law).checks;
    assert!(checks.iter().all(|c| !c.name.is_empty()), "checks have names");
    let lily = bloom::preset("lily").expect("a species that comes with the program");
    for day in [-1.0, 0.0, 0.5 * law.span_days, law.span_days, 1e3] {
        assert_plant(&lily.make_on_day(day, &law, Seed::new(1)));
    }
    true
}

/// Fits the laws of a growth table; `None` if it is not one.
fn fitted(bytes: &[u8]) -> Option<GrowthLaw> {
    let mut rows = read_growth(bytes, &GrowthSpec::default()).ok()?.rows;
    rows.truncate(BOUNDS.rows);
    let mut series: std::collections::BTreeMap<String, Vec<(f64, f64)>> = std::collections::BTreeMap::new();
    for row in rows {
        series.entry(format!("plant {}: {}", row.plant, row.organ)).or_default().push((row.day, row.size));
    }
    let series: Vec<(String, Series)> = series
        .into_iter()
        .map(|(name, mut rows)| {
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
            rows.dedup_by(|a, b| a.0 <= b.0);
            let (days, values) = rows.into_iter().unzip();
            (name, Series { days, values })
        })
        .collect();
    match bloom::fit_sizes("fuzz", &series, Offset::Auto, &Run::plain()) {
        Ok(law) => Some(law),
        Err(e) => {
            refused(&e);
            None
        }
    }
}

/// Reads scans of several days, a point in each line: `day,organ,x,y,z` in metres. Settled, fitted, and in motion.
pub fn stages(bytes: &[u8]) -> bool {
    let stages = scanned(&String::from_utf8_lossy(bytes));
    let run = Run::plain();
    let law = match bloom::fit_stages("fuzz", &stages, &LawSpec::default(), &run) {
        Ok(law) => {
            let faults: Vec<_> = law.validate().collect();
            assert!(faults.is_empty() || law.laws.is_empty(), "what was fitted is sound: {faults:?}");
            law
        }
        Err(e) => {
            refused(&e);
            GrowthLaw::logistic("fuzz", 1.0, 1.0)
        }
    };
    if let Err(e) = bloom::odd_stages(&stages, &run) {
        refused(&e);
    }
    let settled = match bloom::settle(&stages, &RegisterSpec::default(), &run) {
        Ok(settled) => settled,
        Err(e) => return is_refused(&e),
    };
    let moving = Motion::new(&settled.stages, law, MotionSpec::default(), &run);
    let motion = match moving {
        Ok(motion) => motion,
        Err(e) => return is_refused(&e),
    };
    let count = motion.points_on_day(0.0, &run).expect("nobody cancels").len();
    let span = stages.last().map_or(1.0, |s| s.day) - stages.first().map_or(0.0, |s| s.day);
    for day in [0.0, 0.5 * span, span] {
        let points = motion.points_on_day(day, &run).expect("nobody cancels");
        assert_eq!(points.len(), count, "the same points on every day");
        let colors = motion.colors(day);
        assert!(colors.iter().all(Vec::is_empty), "scans without colours");
    }
    true
}

fn is_refused(e: &BloomError) -> bool {
    assert!(!matches!(e, BloomError::Cancelled), "nobody cancels");
    refused(e)
}

/// Parses the stages of a text of `stages`: increasing days, finite points in metres.
fn scanned(text: &str) -> Vec<Stage> {
    let mut stages: Vec<Stage> = Vec::new();
    for line in text.lines() {
        let mut fields = line.split(',');
        let (Some(day), Some(name)) = (fields.next(), fields.next()) else { continue };
        let numbers: Vec<f64> = fields.filter_map(|f| f.trim().parse().ok()).collect();
        let (Ok(day), &[x, y, z]) = (day.trim().parse::<f64>(), numbers.as_slice()) else { continue };
        let point = DVec3::new(x, y, z);
        if !(day.is_finite() && point.is_finite()) {
            continue;
        }
        if stages.last().is_none_or(|s| s.day < day) && stages.len() < BOUNDS.stages {
            stages.push(Stage { day, organs: Vec::new() });
        }
        let Some(stage) = stages.last_mut().filter(|s| s.day == day) else { continue };
        let row = stage.organs.iter().position(|o| o.name == name).unwrap_or(stage.organs.len());
        if row == stage.organs.len() {
            if row == BOUNDS.organs {
                continue;
            }
            stage.organs.push(organ(name, point));
        }
        let organ = &mut stage.organs[row];
        if organ.points.len() < BOUNDS.organ_points {
            organ.rows.push(organ.points.len());
            organ.points.push(point);
        }
    }
    for organ in stages.iter_mut().flat_map(|s| &mut s.organs) {
        let base = organ.base;
        let far = organ.points.iter().map(|p| p.distance(base)).fold(0.0, f64::max);
        let share = |p: &DVec3| if far > 0.0 { (p.distance(base) / far).min(1.0) } else { 0.0 };
        organ.way = organ.points.iter().map(share).collect();
        let tip = organ
            .points
            .iter()
            .copied()
            .reduce(|a, b| if b.distance(base) > a.distance(base) { b } else { a });
        organ.tip = tip.unwrap_or(base);
    }
    stages
}

/// Makes an organ whose base is its first point.
fn organ(name: &str, base: DVec3) -> ScanOrgan {
    let (rows, points, colors, way) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    ScanOrgan { name: name.into(), rows, points, colors, way, base, tip: base, ..ScanOrgan::default() }
}

/// Checks that a plant is meshed soundly, or refused.
fn assert_meshes(plant: &Plant, run: &Run<'_>) {
    let spec = SkinSpec { textures: false, detail: 0.3, ..SkinSpec::default() };
    match burgeon::skin::skin(plant, &spec, run) {
        Ok(model) => assert_model(&model),
        Err(e) => drop(refused(&e)),
    }
}

//! Valid syntax, absurd content: files that every reader accepts, and that no person would call a plant.
//!
//! Each family lists the ways in which its cases may end. `BURGEON_ABSURD=N` runs N cases instead of 600. A case
//! depends on its number alone, and a failure names it: `BURGEON_ABSURD=1 BURGEON_ABSURD_SEED=that` repeats it.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "tests, whose files need not be the same everywhere"
)]

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use serde_json::Value;

use crate::generated::{Dice, asked, run};
use crate::tools::{FLOWER, folder, json, names};

/// End of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    /// Exit status 2 and one line.
    Refused,
    /// A result with a failed check, and its remedy.
    Doubted,
    /// A result that passes all checks, with a warning.
    Warned,
    /// A result that passes all checks, without any.
    Plausible,
}

use End::{Doubted, Plausible, Refused, Warned};

/// Files with one kind of absurd content, and the command that reads them.
struct Family {
    name: &'static str,
    args: &'static str,
    file: &'static str,
    content: fn(&mut Dice) -> String,
    /// All the ways in which its cases may end; each case ends in one of them.
    ends: &'static [End],
}

const SKETCH: &str = "sketch in.svg";
const GROW: &str = "grow in.toml";
const POINTS: &str = "grow --attractors in.xyz --influence 3 --kill 0.5";
const SCAN: &str = "scan in.xyz";
const FIT: &str = "bloom fit in.csv -o law.json";
const MARKS: &str = "leaf in.csv --texture plain --subdivisions 1 --sides 4";

/// Writes a hundred marks of a plain leaf, scaled by `unit`; `mark(row, k)` gives the mark whose position mark k has.
fn marks(unit: f64, mark: impl Fn(usize, usize) -> (usize, usize)) -> String {
    let mut text = String::from("# unit: m\nrow,mark,x,y,z,thickness,midrib\n");
    let _ = writeln!(text, "tip,,0,0,{},,{}", 0.1 * unit, 0.0005 * unit);
    for row in 1..=6 {
        for k in 1..=7 {
            let (r, m) = mark(row, k);
            let (across, along) = ((m as f64 - 4.0) / 3.0, 0.1 - 0.015 * r as f64);
            let half = 0.01 + 0.004 * (r as f64 * (7.0 - r as f64)).sqrt();
            let x = across * half * unit;
            let (y, z) = (0.1 * half * across.abs() * unit, along * unit);
            let midrib = if k == 4 { format!("{}", 0.001 * unit) } else { String::new() };
            let _ = writeln!(text, "{row},{k},{x:.6},{y:.6},{z:.6},{},{midrib}", 0.0003 * unit);
        }
    }
    text
}

/// Returns a number from `low` to `high`, more often a small one.
fn between(dice: &mut Dice, low: f64, high: f64) -> f64 {
    low * (high / low).powf(dice.below(1000) as f64 / 999.0)
}

fn even(dice: &mut Dice) -> f64 {
    dice.below(10_000) as f64 / 10_000.0
}

fn svg(paths: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 400 400\"><g fill=\"none\" stroke=\"#000\">{paths}</g></svg>"
    )
}

fn path(points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<String> = points.map(|(x, y)| format!("{x:.2} {y:.2}")).collect();
    format!("<path d=\"M{}\"/>", points.join("L"))
}

fn one_dot(dice: &mut Dice) -> String {
    let (x, y) = (400.0 * even(dice), 400.0 * even(dice));
    svg(&path([(x, y); 3].into_iter()))
}

fn one_line(dice: &mut Dice) -> String {
    let (x, y, dx, dy) = (200.0, 200.0, even(dice) - 0.5, even(dice) - 0.5);
    svg(&path((0..20).map(|k| (x + 300.0 * dx * f64::from(k) / 19.0, y + 300.0 * dy * f64::from(k) / 19.0))))
}

fn equal_strokes(dice: &mut Dice) -> String {
    let one = path((0..12).map(|k| (100.0 + 3.0 * f64::from(k % 3), 50.0 + 20.0 * f64::from(k))));
    svg(&one.repeat(40 + dice.below(60)))
}

fn framed_speck(dice: &mut Dice) -> String {
    let frame = path([(0.0, 0.0), (400.0, 0.0), (400.0, 400.0), (0.0, 400.0), (0.0, 0.0)].into_iter());
    let (x, y) = (390.0 * even(dice), 390.0 * even(dice));
    svg(&(frame + &path((0..6).map(|k| (x + f64::from(k % 2), y + f64::from(k))))))
}

fn far_stroke(dice: &mut Dice) -> String {
    let plant = path((0..20).map(|k| (10.0 + f64::from(k % 2), 10.0 + f64::from(k))));
    let far = between(dice, 1e3, 1e5);
    svg(&(plant + &path((0..20).map(|k| (far + f64::from(k % 2), far + f64::from(k))))))
}

fn noise(dice: &mut Dice) -> String {
    let strokes = 3 + dice.below(30);
    let lines: Vec<String> =
        (0..strokes).map(|_| path((0..12).map(|_| (400.0 * even(dice), 400.0 * even(dice))))).collect();
    svg(&lines.concat())
}

fn giant_tree(dice: &mut Dice) -> String {
    let radius = between(dice, 150.0, 5e5);
    let steps = format!("step_m = {0}\nattraction_m = {1}\nkill_m = {0}\n", radius / 20.0, radius / 2.0);
    format!(
        "name = \"giant\"\nbare = true\n[method]\nkind = \"colonization\"\npoints = 300\n[method.envelope]\nshape = \"sphere\"\n\
         centre = [0, {radius}, 0]\nradius_m = {radius}\n[method.steps]\n{steps}"
    )
}

fn tree_in_a_block(dice: &mut Dice) -> String {
    let high = 1.0 + 3.0 * even(dice);
    format!(
        "name = \"walled\"\n[method]\nkind = \"colonization\"\npoints = 300\n[method.envelope]\nshape = \"sphere\"\n\
         centre = [0, {0}, 0]\nradius_m = 1.0\n[[obstacles]]\nshape = \"box\"\nmin = [-2, {1}, -2]\nmax = [2, {2}, 2]\n",
        high + 1.5,
        high + 0.1,
        high + 4.0
    )
}

fn points(count: usize, mut place: impl FnMut() -> [f64; 3]) -> String {
    let line = |[x, y, z]: [f64; 3]| format!("{x:.4} {y:.4} {z:.4}\n");
    (0..count).map(|_| line(place())).collect()
}

fn far_points(dice: &mut Dice) -> String {
    let far = between(dice, 20.0, 1000.0);
    points(200, || [far + even(dice), 2.0 * even(dice), even(dice)])
}

fn plane_of_points(dice: &mut Dice) -> String {
    let high = 1.0 + 2.0 * even(dice);
    points(300, || [4.0 * even(dice) - 2.0, high, 4.0 * even(dice) - 2.0])
}

/// Writes a scan of a bare tree, +Z up: a stem that forks, `unit` metres to the metre, at `x`.
fn scanned(dice: &mut Dice, unit: f64, x: f64) -> String {
    let mut branch = 0;
    points(4000, || {
        branch = (branch + 1) % 5;
        let (turn, up) = (core::f64::consts::TAU * even(dice), even(dice));
        let (radius, out) = match branch {
            0 | 1 => (0.12 - 0.05 * up, 0.0),
            _ => (0.04, 2.0 * up),
        };
        let around = core::f64::consts::TAU * f64::from(branch) / 3.0;
        let (low, long) = if branch < 2 { (0.0, 4.0) } else { (4.0, 2.0) };
        let place = [
            x + out * around.cos() + radius * turn.cos(),
            out * around.sin() + radius * turn.sin(),
            low + long * up,
        ];
        place.map(|c| c * unit)
    })
}

fn scan_in_millimetres(dice: &mut Dice) -> String {
    scanned(dice, 1000.0, 0.0)
}

fn scan_in_kilometres(dice: &mut Dice) -> String {
    scanned(dice, 0.001, 0.0)
}

fn two_trees(dice: &mut Dice) -> String {
    let apart = 6.0 + 10.0 * even(dice);
    scanned(dice, 1.0, 0.0) + &scanned(dice, 1.0, apart)
}

fn scanned_plane(dice: &mut Dice) -> String {
    points(3000, || [10.0 * even(dice), 10.0 * even(dice), 0.0])
}

fn ball_of_noise(dice: &mut Dice) -> String {
    points(3000, || [even(dice), even(dice), even(dice)].map(|c| 5.0 * c))
}

fn marks_crossed(dice: &mut Dice) -> String {
    let turned = 1 + dice.below(6);
    marks(1.0, |row, k| if row == turned || row == 7 - turned { (7 - row, 8 - k) } else { (row, k) })
}

fn marks_in_another_unit(dice: &mut Dice) -> String {
    marks(
        if dice.below(2) == 0 { between(dice, 100.0, 1e4) } else { between(dice, 1e-6, 0.009) },
        |row, k| (row, k),
    )
}

fn marks_of_one_point(dice: &mut Dice) -> String {
    let at = dice.below(6);
    marks(1.0, |_, _| (at, 4))
}

fn table(days: usize, size: impl Fn(f64) -> f64) -> String {
    let mut text = String::from("organ,day,size\n");
    for day in 0..days {
        let _ = writeln!(text, "leaf,{day},{:.6}", size(day as f64));
    }
    text
}

fn constant_table(dice: &mut Dice) -> String {
    let size = between(dice, 0.001, 10.0);
    table(4 + dice.below(10), |_| size)
}

fn shrinking_table(dice: &mut Dice) -> String {
    let rate = 0.02 + 0.5 * even(dice);
    table(5 + dice.below(10), |day| 0.3 / (1.0 + (rate * day).exp()) + 0.01)
}

fn three_days(dice: &mut Dice) -> String {
    let rate = 1.0 + even(dice);
    table(3, |day| 0.01 + 0.01 * rate * day)
}

fn edits_that_remove_all(dice: &mut Dice) -> String {
    let at = if dice.below(2) == 0 { 0.0 } else { 0.001 * even(dice) };
    format!(
        "{{\"schema\": \"burgeon.edits/1\", \"edits\": [{{\"op\": \"leaf-density\", \"region\": \"all\", \"keep\": 0}}, \
         {{\"op\": \"prune\", \"axis\": {{\"path\": [0]}}, \"at\": {at}}}]}}"
    )
}

/// Families; each file lies next to a drawing, `flower.svg`.
const FAMILIES: [Family; 23] = [
    Family { name: "a dot", args: SKETCH, file: "in.svg", content: one_dot, ends: &[Refused] },
    // A line by itself is a stem by rule: there was no alternative that could be doubted.
    Family {
        name: "a line",
        args: SKETCH,
        file: "in.svg",
        content: one_line,
        ends: &[Doubted, Warned, Plausible],
    },
    Family { name: "equal strokes", args: SKETCH, file: "in.svg", content: equal_strokes, ends: &[Doubted] },
    Family {
        name: "a speck in a frame",
        args: SKETCH,
        file: "in.svg",
        content: framed_speck,
        ends: &[Doubted, Warned],
    },
    Family {
        name: "two specks far apart",
        args: SKETCH,
        file: "in.svg",
        content: far_stroke,
        ends: &[Doubted, Warned],
    },
    Family {
        name: "noise of strokes",
        args: SKETCH,
        file: "in.svg",
        content: noise,
        // Few of them pass: random crossing lines may look like a bare bush.
        ends: &[Doubted, Warned, Plausible],
    },
    Family {
        name: "a giant tree",
        args: GROW,
        file: "in.toml",
        content: giant_tree,
        ends: &[Refused, Doubted],
    },
    Family {
        name: "a crown in a block",
        args: GROW,
        file: "in.toml",
        content: tree_in_a_block,
        ends: &[Refused],
    },
    Family {
        name: "points out of reach",
        args: POINTS,
        file: "in.xyz",
        content: far_points,
        ends: &[Doubted, Plausible],
    },
    Family {
        name: "a plane of points",
        args: POINTS,
        file: "in.xyz",
        content: plane_of_points,
        ends: &[Plausible],
    },
    Family {
        name: "a scan in millimetres",
        args: SCAN,
        file: "in.xyz",
        content: scan_in_millimetres,
        ends: &[Refused],
    },
    Family {
        name: "a scan in kilometres",
        args: SCAN,
        file: "in.xyz",
        content: scan_in_kilometres,
        ends: &[Refused],
    },
    Family {
        name: "two trees",
        args: SCAN,
        file: "in.xyz",
        content: two_trees,
        ends: &[Doubted, Warned, Plausible],
    },
    Family { name: "a scanned plane", args: SCAN, file: "in.xyz", content: scanned_plane, ends: &[Refused] },
    Family {
        name: "a ball of noise",
        args: SCAN,
        file: "in.xyz",
        content: ball_of_noise,
        ends: &[Doubted, Refused],
    },
    Family {
        name: "crossing marks",
        args: MARKS,
        file: "in.csv",
        content: marks_crossed,
        ends: &[Refused, Doubted, Plausible],
    },
    Family {
        name: "marks in another unit",
        args: MARKS,
        file: "in.csv",
        content: marks_in_another_unit,
        ends: &[Refused, Doubted],
    },
    Family {
        name: "marks of one point",
        args: MARKS,
        file: "in.csv",
        content: marks_of_one_point,
        ends: &[Refused],
    },
    Family {
        name: "a table that stands still",
        args: FIT,
        file: "in.csv",
        content: constant_table,
        ends: &[Doubted],
    },
    Family {
        name: "a table that shrinks",
        args: FIT,
        file: "in.csv",
        content: shrinking_table,
        ends: &[Doubted],
    },
    Family { name: "three days", args: FIT, file: "in.csv", content: three_days, ends: &[Doubted] },
    Family {
        name: "edits that remove a drawing",
        args: "shape flower.svg --edits in.json",
        file: "in.json",
        content: edits_that_remove_all,
        ends: &[Warned],
    },
    Family {
        name: "edits that remove a tree",
        args: "shape palm --edits in.json",
        file: "in.json",
        content: edits_that_remove_all,
        ends: &[Warned],
    },
];

/// Runs one case: returns how it ended, or the fault.
fn case(seed: u64, dir: &Path) -> Result<(usize, End), String> {
    let which = usize::try_from(seed).unwrap() % FAMILIES.len();
    let family = &FAMILIES[which];
    let mut dice = Dice(seed);
    let _ = fs::remove_dir_all(dir);
    fs::create_dir_all(dir).unwrap();
    fs::write(dir.join(family.file), (family.content)(&mut dice)).unwrap();
    fs::write(dir.join("flower.svg"), FLOWER).unwrap();
    let before = names(dir);
    let args = family.args.split(' ').chain(["-q", "--report", "report.json"]);
    let args: Vec<OsString> = args.map(OsString::from).collect();
    let ran = run(dir, &args, None);
    let fault =
        |what: &str| format!("case {seed}, {}: {what}; status {:?}, {:?}", family.name, ran.status, ran.told);
    let end = match ran.status {
        Some(2) if ran.told.starts_with("error: ") && ran.told.trim_end().lines().count() == 1 => {
            if names(dir) != before {
                return Err(fault("failed and wrote files"));
            }
            Refused
        }
        Some(0) => {
            let report = json(&dir.join("report.json"));
            let checks = report["items"][0]["checks"].as_array().filter(|c| !c.is_empty());
            let checks = checks.ok_or_else(|| fault("nothing was checked"))?;
            let failed: Vec<&Value> = checks.iter().filter(|c| c["ok"] == false).collect();
            if failed.iter().any(|c| c["advice"].as_str().unwrap_or_default().len() < 10) {
                return Err(fault("a check has no way out"));
            }
            let warned = report["items"][0]["warnings"].as_array().is_some_and(|w| !w.is_empty());
            match (failed.is_empty(), warned) {
                (false, _) => Doubted,
                (true, true) => Warned,
                (true, false) => Plausible,
            }
        }
        _ => return Err(fault("is neither a result nor one line of error")),
    };
    if !family.ends.contains(&end) {
        return Err(fault(&format!("ended {end:?}, not {:?}", family.ends)));
    }
    Ok((which, end))
}

#[test]
fn absurd_content_is_refused_or_doubted_or_makes_a_plausible_plant() {
    let (from, count) = (asked("BURGEON_ABSURD_SEED", 0), asked("BURGEON_ABSURD", 600));
    let next = AtomicU64::new(from);
    let (ends, faults) = (Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
    let workers = std::thread::available_parallelism().map_or(2, usize::from).min(8);
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let (next, ends, faults) = (&next, &ends, &faults);
            scope.spawn(move || {
                let dir = folder(&format!("absurd-{worker}"));
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= from + count {
                        break;
                    }
                    match case(seed, &dir.join("case")) {
                        Ok(end) => *ends.lock().unwrap().entry(end).or_insert(0) += 1,
                        Err(fault) => faults.lock().unwrap().push((seed, fault)),
                    }
                }
            });
        }
    });
    for ((which, end), cases) in ends.into_inner().unwrap() {
        println!("{}: {cases} {end:?}", FAMILIES[which].name);
    }
    let mut faults = faults.into_inner().unwrap();
    faults.sort();
    let lines: Vec<&str> = faults.iter().map(|(_, f)| f.as_str()).collect();
    assert!(lines.is_empty(), "{} of {count} cases:\n{}", lines.len(), lines.join("\n"));
}

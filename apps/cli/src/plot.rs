//! `burgeon scan --all`: each tree of a plot, with an inventory and a map.

use std::path::{Path, PathBuf};

use burgeon::formats::PngCache;
use burgeon::glam::DVec3;
use burgeon::mesh::{PointClass, PointCloud};
use burgeon::scan::{FoundTree, Plot, find_plot};
use burgeon::{
    Digest, ItemReport, Report, RunReport, ScanTreeOptions, ScannedTreeError, Seed, UpAxis, make_tree_of_plot,
};
use serde::{Deserialize, Serialize};

use crate::args::{ScanArgs, Seen};
use crate::failure::{Failure, Outcome};
use crate::levels::{self, Form, Whole};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::plot_map::map_of;
use crate::scan::{Read, failure, inputs_of, options_of, read};
use crate::{checks, files, inputs, picture, report, say};

/// A row of the inventory, which is also stored next to each tree, so that an interrupted run can continue.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Row {
    /// Digest of the tree's points, the options and the version: a tree with the same digest is not made again.
    made_from: String,
    tree: String,
    /// Position in the coordinates and the unit of the scan: the two that are not up.
    place: [f64; 2],
    points: usize,
    height_m: f64,
    height_interval_m: [f64; 2],
    dbh_m: Option<f64>,
    dbh_interval_m: Option<[f64; 2]>,
    wood_volume_m3: f64,
    wood_volume_interval_m3: [f64; 2],
    crown_base_m: Option<f64>,
    crown_projection_m2: f64,
    explained: f64,
    pipe_source: String,
    /// Whether its crown ends where the cloud does.
    is_cut: bool,
    warnings: Vec<String>,
}

/// Figures of the plot, in the report.
#[derive(Debug, Serialize)]
struct PlotTally {
    points: usize,
    ground: usize,
    others: usize,
    loose: usize,
    stems: usize,
    kept: usize,
    cut: usize,
}

#[derive(Debug, Serialize)]
struct PlotRun {
    #[serde(flatten)]
    run: RunReport,
    plot: PlotTally,
    trees: Vec<Row>,
}

/// A plot in the making.
struct Making<'a> {
    args: &'a ScanArgs,
    folder: &'a Path,
    machine: &'a Machine,
    options: ScanTreeOptions,
    read: Read,
    plot: Plot,
}

pub(crate) fn scan_all(args: &ScanArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let folder = args.output.as_deref().ok_or_else(|| Failure::Bug("--all without -o".into()))?;
    if files::extension(folder).is_some() && !folder.is_dir() {
        return Err(Failure::bad_file(folder, "--all makes many files; give a folder: -o FOLDER"));
    }
    let mut outputs = Outputs::new(&[("--report", args.common.report.as_ref())], &inputs_of(args))?;
    let format = Some(files::plant_writable(Path::new("tree.glb"))?);
    args.given.check_picture(false, &args.picture)?;
    args.given.check_surface(Seen::new(format, None, &args.common))?;
    args.surface.check_used(&args.given, format, false)?;
    let one = ["lods", "instances", "triangles", "megabytes", "impostor"];
    args.given.refuse(&one, "single trees", "--all makes a model of each tree")?;
    outputs.folder(folder)?;
    let mut told = Report::default();
    let options = options_of(args, &mut told)?;
    let mut read = read(args, &machine, &mut told)?;
    outputs.check()?;
    let plot = machine
        .with_progress("stems", |_| find_plot(&read.cloud, &options.scan, &machine.run(), &mut told))
        .map_err(|e| {
            let offset = read.origin.offset_m.unwrap_or_default();
            failure(&args.input, ScannedTreeError::from(e).in_scan(&read.axes, offset))
        })?;
    read.cloud = PointCloud::default();
    let making = Making { args, folder, machine: &machine, options, read, plot };
    let (rows, kept, mut run) = making.trees(&outputs)?;
    run.warnings.splice(0..0, told.warnings.iter().map(ToString::to_string));
    making.write_lists(&rows, &mut outputs)?;
    let plot = PlotTally {
        points: making.plot.points,
        ground: making.plot.ground_points,
        others: making.plot.others,
        loose: making.plot.loose,
        stems: making.plot.trees.len(),
        kept,
        cut: rows.iter().filter(|r| r.is_cut).count(),
    };
    let whole = PlotRun { run, plot, trees: rows };
    report::finish(&whole, &args.common, outputs)?;
    whole.run.warnings.iter().for_each(|w| say::warning(w));
    if !machine.quiet {
        tell(&whole, folder, &machine);
    }
    if whole.run.failed > 0 { Err(Failure::Reported) } else { Ok(()) }
}

fn tell(whole: &PlotRun, folder: &Path, machine: &Machine) {
    for row in &whole.trees {
        let dbh = row.dbh_m.map_or_else(|| "none".into(), |d| format!("{:.1} cm", 100.0 * d));
        let doubts = match row.warnings.len() {
            0 => String::new(),
            n => format!("; {}", say::counted(n as u64, "warning", "warnings")),
        };
        say::line(&format!(
            "{} at {:.2},{:.2}: {:.2} m high, DBH {dbh}, {:.4} m3 of wood ({:.4} to {:.4}){doubts}",
            row.tree,
            row.place[0],
            row.place[1],
            row.height_m,
            row.wood_volume_m3,
            row.wood_volume_interval_m3[0],
            row.wood_volume_interval_m3[1]
        ));
    }
    let p = &whole.plot;
    let share = |n: usize| 100.0 * n as f64 / p.points.max(1) as f64;
    let failed = match whole.run.failed {
        0 => String::new(),
        n => format!(", {} failed", say::counted(n, "tree", "trees")),
    };
    say::line(&format!(
        "{}: {} ({} kept, {} cut by the edge{failed}), inventory.csv, map.png; {:.0} % of the points are ground, {:.0} % of \
         other things, {:.0} % loose; {:.1} s",
        folder.display(),
        say::counted(whole.run.ok, "tree", "trees"),
        p.kept,
        p.cut,
        share(p.ground),
        share(p.others),
        share(p.loose),
        machine.whole_ms() / 1000.0
    ));
}

impl Making<'_> {
    /// Makes each tree in turn; a failure does not stop the others.
    fn trees(&self, outputs: &Outputs) -> Outcome<(Vec<Row>, usize, RunReport)> {
        let mut run = RunReport::new("scan", self.args.seed);
        run.input.path = self.args.input.display().to_string();
        run.input.offset_m = self.read.origin.offset_in(&self.read.axes);
        run.input.coordinate_system.clone_from(&self.read.facts.coordinate_system);
        let (mut rows, mut kept) = (vec![], 0);
        for k in 0..self.plot.trees.len() {
            self.machine.cancel.check()?;
            let name = format!("tree-{:03}", k + 1);
            let points = self.plot.points_of(k);
            let made_from = self.made_from(&points, &self.plot.classes_of(k));
            drop(points);
            if let Some(row) = self.kept(&name, &made_from) {
                kept += 1;
                run.ok += 1;
                run.items.push(ItemReport { name, warnings: row.warnings.clone(), ..ItemReport::default() });
                rows.push(row);
                continue;
            }
            match self.tree(k, &name, made_from, outputs) {
                Ok((row, item)) => {
                    run.ok += 1;
                    run.items.push(item);
                    rows.push(row);
                }
                Err(Failure::Bad(what)) => {
                    run.failed += 1;
                    let [a, b] = self.place(self.plot.trees[k].place);
                    run.warnings.push(format!("{name} at {a:.2},{b:.2}: no tree was made: {what}"));
                }
                Err(other) => return Err(other),
            }
        }
        Ok((rows, kept, run))
    }

    fn tree(&self, k: usize, name: &str, made_from: String, outputs: &Outputs) -> Outcome<(Row, ItemReport)> {
        let run = self.machine.run();
        let seed = Seed::new(self.args.seed).child(k as u64);
        let made = self
            .machine
            .with_progress(name, |_| make_tree_of_plot(name, (&self.plot, k), &self.options, seed, &run));
        let offset = self.read.origin.offset_m.unwrap_or_default();
        let (made, found) = made.map_err(|e| failure(Path::new(name), e.in_scan(&self.read.axes, offset)))?;
        let path = self.file(name, "glb");
        let format = files::plant_writable(&path)?;
        let levels = made.levels(&self.args.surface.export.levels(Some(format)), &run);
        let levels = levels.map_err(|e| failure(Path::new(name), e.into()))?;
        let mut items = vec![made.item];
        checks::accept(&items, &self.args.checks)?;
        let row = self.row(k, name, made_from, &found, &items[0]);
        let mut own = outputs.for_one();
        let form = Form::new(&path, format, &self.args.surface.export, &self.args.axes);
        let whole = Whole { plant: &made.plant, model: made.model, levels };
        levels::write(&mut own, &form, whole, &mut items, &mut PngCache::new(), self.machine)?;
        files::write_qsm(&mut own, &self.file(name, "csv"), &made.plant, &self.args.axes)?;
        let text = serde_json::to_string_pretty(&row)
            .map_err(|e| Failure::Bug(format!("a row cannot be written as JSON: {e}")))?;
        own.write("-o", &self.file(name, "json"), |out| Ok(writeln!(out, "{text}")?))?;
        own.place()?;
        Ok((row, items.swap_remove(0)))
    }

    fn row(&self, k: usize, name: &str, made_from: String, found: &FoundTree, item: &ItemReport) -> Row {
        let of = &self.plot.trees[k];
        let m = item.plant.clone().unwrap_or_default();
        let i = found.intervals;
        Row {
            made_from,
            tree: name.to_owned(),
            place: self.place([found.foot.x, found.foot.z]),
            points: of.points,
            height_m: m.height_m,
            height_interval_m: [i.height_m.low, i.height_m.high],
            dbh_m: m.dbh_m,
            dbh_interval_m: i.dbh_m.map(|d| [d.low, d.high]),
            wood_volume_m3: m.wood_volume_m3,
            wood_volume_interval_m3: [i.volume_m3.low, i.volume_m3.high],
            crown_base_m: m.crown_base_m,
            crown_projection_m2: m.crown_projection_m2,
            explained: found.tally.explained,
            pipe_source: found.tally.pipe_source.word().to_owned(),
            is_cut: of.is_cut,
            warnings: item.warnings.clone(),
        }
    }

    /// Returns a place in the coordinates of the scan: the two that are not up.
    fn place(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        let offset = self.read.origin.offset_m.unwrap_or_default();
        let [a, b, c] = self.read.axes.place(DVec3::new(x, 0.0, z) + offset);
        if self.read.axes.up == UpAxis::Y { [a, c] } else { [a, b] }
    }

    fn file(&self, name: &str, extension: &str) -> PathBuf {
        self.folder.join(format!("{name}.{extension}"))
    }

    /// The input of a tree: its points and their classes, the options, the version.
    fn made_from(&self, points: &[DVec3], classes: &[PointClass]) -> String {
        let args = self.args;
        let mut digest = Digest::new();
        digest.add(points).add(&args.seed);
        for class in classes {
            digest.bytes(class.word().as_bytes());
        }
        let options = format!(
            "{} {:?} {:?} {:?} {:?} {:?}",
            env!("CARGO_PKG_VERSION"),
            self.options.scan,
            self.options.leaves,
            args.surface,
            args.axes,
            args.checks.strict
        );
        digest.bytes(options.as_bytes());
        digest.hex()
    }

    /// Returns the row of a tree of an earlier run, if it is whole and has the same digest.
    fn kept(&self, name: &str, made_from: &str) -> Option<Row> {
        let row: Row = serde_json::from_slice(&inputs::read_own(&self.file(name, "json")).ok()?).ok()?;
        let is_whole = ["glb", "csv"].iter().all(|e| self.file(name, e).is_file());
        (row.made_from == made_from && is_whole).then_some(row)
    }

    /// Writes the inventory and the map.
    fn write_lists(&self, rows: &[Row], outputs: &mut Outputs) -> Outcome {
        let unit = self.args.axes.unit.word();
        let [a, b] = if self.read.axes.up == UpAxis::Y { ["x", "z"] } else { ["x", "y"] };
        outputs.write("-o", &self.folder.join("inventory.csv"), |out| {
            writeln!(
                out,
                "tree,{a}_{unit},{b}_{unit},height_m,height_low_m,height_high_m,dbh_m,dbh_low_m,dbh_high_m,wood_volume_m3,\
                 wood_volume_low_m3,wood_volume_high_m3,crown_base_m,crown_projection_m2,points,explained,pipe_exponent,\
                 cut_by_edge,warnings"
            )?;
            for r in rows {
                let some = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
                let dbh = r.dbh_interval_m;
                writeln!(
                    out,
                    "{},{:.3},{:.3},{:.3},{:.3},{:.3},{},{},{},{:.5},{:.5},{:.5},{},{:.2},{},{:.3},{},{},{}",
                    r.tree,
                    r.place[0],
                    r.place[1],
                    r.height_m,
                    r.height_interval_m[0],
                    r.height_interval_m[1],
                    some(r.dbh_m),
                    some(dbh.map(|d| d[0])),
                    some(dbh.map(|d| d[1])),
                    r.wood_volume_m3,
                    r.wood_volume_interval_m3[0],
                    r.wood_volume_interval_m3[1],
                    some(r.crown_base_m),
                    r.crown_projection_m2,
                    r.points,
                    r.explained,
                    r.pipe_source,
                    r.is_cut,
                    r.warnings.len()
                )?;
            }
            Ok(())
        })?;
        picture::write(outputs, "-o", &self.folder.join("map.png"), &map_of(&self.plot))
    }
}

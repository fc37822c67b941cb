//! `burgeon scan`: a laser scan to a tree.

use std::path::{Path, PathBuf};

use burgeon::formats::{CloudFacts, ExportSpec, PngCache, StructureFormat};
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;
use burgeon::scan::{FoundTree, Interval, ScanTreeError, TreeScanSpec};
use burgeon::skin::SkinSpec;
use burgeon::{
    ItemReport, Report, RunReport, ScanTreeOptions, ScannedTreeError, Seed, Stopped, UpAxis,
    make_tree_from_scan,
};
use serde::Serialize;

use crate::args::{ScanArgs, Seen};
use crate::failure::{Failure, Outcome};
use crate::levels::{Form, Whole};
use crate::machine::Machine;
use crate::materials::Materials;
use crate::origin::Origin;
use crate::output::Outputs;
use crate::{checks, files, grow, levels, picture, report, say};

/// Figures of the points and the tree.
#[derive(Debug, Serialize)]
struct ScanTally {
    points: u64,
    ground: u64,
    noise: u64,
    others: u64,
    /// Number of leaves; 0 for a bare tree.
    leaves: u64,
    wood: u64,
    other_things: u64,
    /// Number of trunks seen at breast height.
    stems: u64,
    /// Points of large pieces beyond gaps that were not bridged.
    loose: u64,
    /// Share of the tree's points near its wood or in its leaves, and the same for each tenth of the height from below.
    explained: f64,
    coverage: [Option<f64>; 10],
    bridges: u64,
    /// A gap wider than usual that was bridged.
    wide_gap_m: Option<f64>,
    cell_m: f64,
    rings: u64,
    circles: u64,
    pipe_exponent: f64,
    /// `fitted`, `default` or `bound`.
    pipe_source: &'static str,
    pipe_scatter: f64,
    /// Intervals of the figures at 90 %.
    intervals: Intervals,
    /// Position of the stem, in the axes of the scan, metres.
    foot_m: [f64; 3],
    /// Whether a ground was found.
    ground_found: bool,
}

#[derive(Debug, Serialize)]
struct Intervals {
    height_m: [f64; 2],
    dbh_m: Option<[f64; 2]>,
    wood_volume_m3: [f64; 2],
}

#[derive(Debug, Serialize)]
struct ScanRun {
    #[serde(flatten)]
    run: RunReport,
    scan: ScanTally,
}

/// Returns the options of the search and of the surface, and warns of odd ones.
pub(crate) fn options_of(args: &ScanArgs, told: &mut Report) -> Outcome<ScanTreeOptions> {
    let leaves = args.leaves.as_deref().map(|what| grow::read_leaves(what, told)).transpose()?;
    let materials = args.surface.skin.materials.as_deref().map(Materials::read).transpose()?;
    Ok(ScanTreeOptions {
        scan: TreeScanSpec { cell_m: args.cell, gap_m: args.gap, ..TreeScanSpec::default() },
        leaves,
        skin: SkinSpec { worn: materials.unwrap_or_default().worn(), ..args.surface.spec() },
    })
}

/// Returns the input files that the options name.
pub(crate) fn inputs_of(args: &ScanArgs) -> Vec<&PathBuf> {
    let inputs = [Some(&args.input), args.leaves.as_ref(), args.surface.skin.materials.as_ref()];
    inputs.into_iter().flatten().collect()
}

/// A cloud near its origin.
pub(crate) struct Read {
    pub(crate) cloud: PointCloud,
    /// Facts of its file.
    pub(crate) facts: CloudFacts,
    pub(crate) axes: ExportSpec,
    pub(crate) origin: Origin,
    pub(crate) ms: f64,
}

pub(crate) fn read(args: &ScanArgs, machine: &Machine, told: &mut Report) -> Outcome<Read> {
    // Scanners write +Z up.
    let axes = files::axes(args.axes.up.unwrap_or(UpAxis::Z), args.axes.unit);
    let opened = files::open_cloud(&args.input)?;
    let (cloud, ms) = machine.timed(|| {
        machine.with_progress("reading", |_| files::read_cloud_with_facts(&args.input, opened, &axes, told))
    });
    let (mut cloud, facts) = cloud?;
    let mut origin = Origin::default();
    origin.bring(&mut cloud.points, &axes, told);
    Ok(Read { cloud, facts, axes, origin, ms })
}

pub(crate) fn scan(args: &ScanArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", args.output.as_ref()),
        ("--png", args.png.as_ref()),
        ("--qsm", args.qsm.as_ref()),
        ("--mtg", args.mtg.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let mut outputs = Outputs::new(&outputs, &inputs_of(args))?;
    let plan = |path| files::plan_plant(&mut outputs, path, args.surface.export.lod_files());
    let format = args.output.as_deref().map(plan).transpose()?;
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    args.given.check_picture(args.png.is_some(), &args.picture)?;
    args.given.check_surface(Seen::new(format, args.png.as_ref(), &args.common))?;
    args.surface.check_used(&args.given, format, args.png.is_some())?;
    let mut told = Report::default();
    let mut options = options_of(args, &mut told)?;
    let Read { cloud, facts, axes, origin, ms: read_ms } = read(args, &machine, &mut told)?;
    outputs.check()?;
    options.scan.at = args.at.map(|[a, b]| {
        // The two coordinates that are not up.
        let file = if matches!(args.axes.up, Some(UpAxis::Y)) {
            DVec3::new(a, 0.0, b)
        } else {
            DVec3::new(a, b, 0.0)
        };
        let p = origin.place(axes.inward(file));
        [p.x, p.z]
    });
    let (name, seed) = (files::stem(&args.input), Seed::new(args.seed));
    let made =
        machine.with_progress("scan", |_| make_tree_from_scan(&name, &cloud, &options, seed, &machine.run()));
    let offset = origin.offset_m.unwrap_or_default();
    let (mut made, found) = made.map_err(|e| failure(&args.input, e.in_scan(&axes, offset)))?;
    drop(cloud);
    let levels = made.levels(&args.surface.export.levels(format), &machine.run());
    let levels = levels.map_err(|e| failure(&args.input, e.into()))?;
    let stood = offset + found.foot;
    name_options(&mut made.item, &found, &axes, offset);
    made.item.warnings.splice(0..0, told.warnings.iter().map(ToString::to_string));
    made.item.timings_ms.add_io(read_ms, 0.0);
    let mut items = vec![made.item];
    checks::accept(&items, &args.checks).map_err(|f| f.in_file(&args.input))?;
    if let Some((path, format)) = args.output.as_deref().zip(format) {
        let form = Form::new(path, format, &args.surface.export, &args.axes);
        let whole = Whole { plant: &made.plant, model: made.model.clone(), levels };
        levels::write(&mut outputs, &form, whole, &mut items, &mut PngCache::new(), &machine)?;
    }
    if let Some(path) = &args.qsm {
        files::write_qsm(&mut outputs, path, &made.plant, &args.axes)?;
    }
    if let Some(path) = &args.mtg {
        let mtg = StructureFormat::Mtg;
        files::write_structure(&mut outputs, ("--mtg", path), &made.plant, mtg, &args.axes)?;
    }
    if let Some(png) = &args.png {
        let view = args.picture.spec(args.seed);
        let drawn = machine
            .with_progress("picture", |_| burgeon::render::render(&made.model, &view, &machine.run()))?;
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    items[0].timings_ms.total = machine.whole_ms();
    let mut run = RunReport::new("scan", args.seed);
    run.engine = args.surface.export.report();
    run.input.path = args.input.display().to_string();
    run.input.offset_m = origin.offset_in(&axes);
    run.input.coordinate_system = facts.coordinate_system;
    run.ok = 1;
    run.items = items;
    let scan = tally(&found, stood, &axes);
    let whole = ScanRun { run, scan };
    report::finish(&whole, &args.common, outputs)?;
    if !machine.quiet {
        let run = &whole.run;
        for item in &run.items {
            item.warnings.iter().for_each(|w| say::warning(&format!("{}: {w}", item.name)));
        }
        say::line(&summary(&whole, args.png.as_deref()));
        run.items[1..].iter().for_each(|i| say::line(&report::summary(i, None)));
    }
    Ok(())
}

/// Returns the findings in the scan; `stood`: the position of the tree, in the coordinates of the scan.
fn tally(found: &FoundTree, stood: DVec3, axes: &ExportSpec) -> ScanTally {
    let t = &found.tally;
    let metres = ExportSpec { up: axes.up, ..ExportSpec::default() };
    ScanTally {
        points: t.points as u64,
        ground: t.ground as u64,
        noise: t.noise as u64,
        others: t.others as u64,
        leaves: t.leaves as u64,
        wood: t.wood as u64,
        other_things: t.other_things as u64,
        stems: t.stems as u64,
        loose: t.loose as u64,
        explained: t.explained,
        coverage: t.coverage,
        bridges: t.bridges as u64,
        wide_gap_m: t.wide_gap_m,
        cell_m: t.cell_m,
        rings: t.rings as u64,
        circles: t.circles as u64,
        pipe_exponent: t.pipe_exponent,
        pipe_source: t.pipe_source.word(),
        pipe_scatter: t.pipe_scatter,
        intervals: Intervals {
            height_m: pair(found.intervals.height_m),
            dbh_m: found.intervals.dbh_m.map(pair),
            wood_volume_m3: pair(found.intervals.volume_m3),
        },
        foot_m: metres.place(stood),
        ground_found: found.ground.is_some(),
    }
}

const fn pair(i: Interval) -> [f64; 2] {
    [i.low, i.high]
}

/// Adds to warnings the options that help with them.
fn name_options(item: &mut ItemReport, found: &FoundTree, axes: &ExportSpec, offset: DVec3) {
    let stem = found.other_stems.first().map(|&[x, z]| {
        let [a, b, c] = axes.place(DVec3::new(x, 0.0, z) + offset);
        let [a, b] = if axes.up == UpAxis::Y { [a, c] } else { [a, b] };
        format!("--at {a:.2},{b:.2}")
    });
    let gap = found.tally.next_gap_m.map_or(1.0, |g| (10.0 * g + 1.0).ceil() / 10.0);
    let gap = format!("--gap {gap}");
    for (said, told) in item.warnings.iter_mut().zip(&item.told) {
        let options = match told.code {
            "several-stems" | "scan-others" => {
                vec![stem.clone().unwrap_or_else(|| "--at A,B".into()), "--all".into()]
            }
            "volume-large-for-stem" => vec!["--all".into(), "--at A,B".into()],
            "scan-loose" | "tree-cut" | "volume-small-for-stem" => vec![gap.clone()],
            "scan-gap" => vec!["--gap".into()],
            "scan-unused" => vec![gap.clone(), "--at A,B".into(), "--all".into()],
            "scan-unexplained" => vec![gap.clone(), "--cell".into()],
            "tree-small" | "size-small" | "size-large" => vec!["--unit".into()],
            "scan-lies-down" => vec!["--up".into()],
            _ => continue,
        };
        *said = format!("{said} ({})", options.join(", "));
    }
}

fn summary(whole: &ScanRun, png: Option<&Path>) -> String {
    let item = &whole.run.items[0];
    let line = report::summary(item, png);
    let Some(m) = &item.plant else { return line };
    let i = &whole.scan.intervals;
    let dbh = m.dbh_m.zip(i.dbh_m).map_or_else(String::new, |(d, [low, high])| {
        format!(", DBH {:.1} cm ({:.1} to {:.1})", 100.0 * d, 100.0 * low, 100.0 * high)
    });
    let found = format!(
        ", {} points, {:.0} % explained: {:.2} m high ({:.2} to {:.2}){dbh}, {:.4} m3 of wood ({:.4} to {:.4}), {:.0} m of \
         branches; ",
        say::grouped(whole.scan.points),
        100.0 * whole.scan.explained,
        m.height_m,
        i.height_m[0],
        i.height_m[1],
        m.wood_volume_m3,
        i.wood_volume_m3[0],
        i.wood_volume_m3[1],
        m.length_m
    );
    line.replacen("; ", &found, 1)
}

pub(crate) fn failure(path: &Path, error: ScannedTreeError) -> Failure {
    match error {
        ScannedTreeError::Stopped(Stopped::Cancelled(_)) => Failure::Cancelled,
        ScannedTreeError::Scan(e @ ScanTreeError::TooLarge(_)) => {
            Failure::bad_file(path, format_args!("{e}; --unit mm or --unit cm says the unit"))
        }
        ScannedTreeError::Scan(e @ ScanTreeError::TooSmall(_)) => {
            Failure::bad_file(path, format_args!("{e}; --unit m or --unit cm says the unit"))
        }
        ScannedTreeError::Scan(e @ ScanTreeError::NoStem) => Failure::bad_file(
            path,
            format_args!("{e}; --up says which axis points up, --unit the unit, --at where the stem stands"),
        ),
        other => Failure::bad_file(path, other),
    }
}

//! `burgeon bloom fit`: growth laws from scans of several days, or from a growth table.

use burgeon::bloom::{self, Form, GrowthLaw, LawSpec, Quantity, RegionLaw, Rival, Trial};
use burgeon::bloom::{MotionSpec, RegisterSpec, ShapeError};
use burgeon::glam::DVec3;
use burgeon::{RunReport, Seed, check_law};
use serde::Serialize;

use crate::args::FitArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{checks, files, poses, report, say, stages, table};

/// A law in the report, lengths in metres.
#[derive(Debug, Serialize)]
struct LawReport {
    organ: String,
    region: usize,
    axis: Quantity,
    form: Form,
    /// Whether the days determine it; otherwise it is a straight line, or the nearest logistic, and sets no pace.
    determined: bool,
    #[serde(rename = "K")]
    k: f64,
    p0: f64,
    r: f64,
    offset: f64,
    /// Value on day 0, and the asymptote: K and p0 with the constant under the curve; `None` where the days give no
    /// end.
    first_m: f64,
    final_m: Option<f64>,
    /// Standard errors of `final_m` and `first_m`.
    value_errors_m: Option<[f64; 2]>,
    /// Standard errors of K, p0 and r.
    standard_errors: Option<[f64; 3]>,
    r2: f64,
    r2_adjusted: Option<f64>,
    loo_rmse: Option<f64>,
    /// Leave-one-out error of a straight line.
    straight_rmse: Option<f64>,
    /// Error of predicting each value by the one before it.
    last_rmse: Option<f64>,
    /// Whether it lies on a bound of the search: then the series determines no logistic.
    on_bound: bool,
}

impl LawReport {
    fn new(l: &RegionLaw, span: f64) -> Self {
        Self {
            organ: l.organ.clone(),
            region: l.region,
            axis: l.axis,
            form: l.form,
            determined: l.is_determined(),
            k: l.law.k,
            p0: l.law.p0,
            r: l.law.r,
            offset: l.law.offset,
            first_m: l.value(0.0),
            final_m: l.final_value(),
            value_errors_m: l.value_errors,
            standard_errors: l.standard_errors,
            r2: l.r2,
            r2_adjusted: l.r2_adjusted,
            loo_rmse: l.loo_rmse,
            straight_rmse: l.straight_rmse,
            last_rmse: l.last_rmse,
            on_bound: l.form == Form::Logistic && l.law.on_bound(span),
        }
    }
}

/// Mean distances from the scan that was left out to the result of the others, and back.
#[derive(Debug, Serialize)]
struct Distance {
    mean_mm: f64,
    back_mean_mm: f64,
}

impl From<&ShapeError> for Distance {
    fn from(e: &ShapeError) -> Self {
        Self { mean_mm: e.to_model.mean * 1e3, back_mean_mm: e.to_scan.mean * 1e3 }
    }
}

#[derive(Debug, Serialize)]
struct RivalReport {
    way: &'static str,
    /// Distance after the best rigid motion.
    aligned: Distance,
    /// Distance in the coordinates of the scanner.
    scanner: Distance,
}

/// A day that was left out.
#[derive(Debug, Serialize)]
struct TrialReport {
    day: f64,
    extrapolated: bool,
    /// Whether the other days determine a law.
    law: bool,
    ways: Vec<RivalReport>,
}

impl From<&Trial> for TrialReport {
    fn from(t: &Trial) -> Self {
        let ways = t.rows.iter().map(|r| RivalReport {
            way: r.rival.word(),
            aligned: Distance::from(&r.aligned),
            scanner: Distance::from(&r.scanner),
        });
        Self { day: t.day, extrapolated: t.extrapolated, law: t.law, ways: ways.collect() }
    }
}

/// Additions of `fit` to the report.
#[derive(Debug, Serialize)]
struct FitReport {
    #[serde(flatten)]
    run: RunReport,
    laws: Vec<LawReport>,
    stages: Vec<stages::StageReport>,
    /// Motion of plant and organs between scans.
    poses: Vec<poses::PoseReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    leave_one_out: Option<Vec<TrialReport>>,
    /// Whether groups grow alike; for a growth table with --by.
    #[serde(skip_serializing_if = "Option::is_none")]
    groups: Option<table::GroupReport>,
}

/// Input and fits.
struct Fitted {
    law: GrowthLaw,
    warnings: Vec<String>,
    stages: Vec<stages::StageReport>,
    poses: Vec<poses::PoseReport>,
    trials: Option<Vec<Trial>>,
    offset_m: Option<[f64; 3]>,
    read_ms: f64,
    /// Comparison of groups.
    groups: Option<table::GroupReport>,
    fit_ms: f64,
}

impl From<table::TableFit> for Fitted {
    /// Makes the result of a table, which has no scans.
    fn from(table: table::TableFit) -> Self {
        let table::TableFit { law, warnings, groups, read_ms, fit_ms } = table;
        let (stages, poses, trials, offset_m) = (vec![], vec![], None, None);
        Self { law, warnings, stages, poses, trials, offset_m, read_ms, groups, fit_ms }
    }
}

pub(crate) fn fit(args: &FitArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", Some(&args.output)),
        ("--plot", args.plot.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let mut outputs = Outputs::new(&outputs, &[&args.input])?;
    let is_table = files::extension(&args.input)
        .is_some_and(|e| ["csv", "tsv", "xlsx"].iter().any(|known| e.eq_ignore_ascii_case(known)));
    let fitted =
        if is_table { table::fit(args, &machine)?.into() } else { fit_scans(args, &mut outputs, &machine)? };
    let law = &fitted.law;
    let checked = check_law(law);
    let text = serde_json::to_string_pretty(law)
        .map_err(|e| Failure::Bug(format!("the law cannot be written as JSON: {e}")))?;
    let (written, write_ms) = machine.timed(|| {
        outputs.write("-o", &args.output, |out| Ok(writeln!(out, "{text}")?))?;
        match &args.plot {
            Some(plot) => {
                let svg = bloom::plot_svg(law);
                outputs.write("--plot", plot, |out| Ok(out.write_all(svg.as_bytes())?))
            }
            None => Ok(()),
        }
    });
    written?;
    let mut run = report::report_one(
        "bloom fit",
        args.seed,
        &args.input.display().to_string(),
        &law.name,
        &args.output,
    );
    run.input.offset_m = fitted.offset_m;
    if let Some(item) = run.items.first_mut() {
        item.timings_ms.structure = fitted.fit_ms;
        item.timings_ms.add_io(fitted.read_ms, write_ms);
        item.timings_ms.total = machine.whole_ms();
        item.warnings.clone_from(&fitted.warnings);
        item.add_checks(checked);
    }
    checks::accept(&run.items, &args.checks)?;
    let report = FitReport {
        run,
        laws: law.laws.iter().map(|l| LawReport::new(l, law.span_days)).collect(),
        stages: fitted.stages,
        poses: fitted.poses,
        leave_one_out: fitted.trials.as_ref().map(|t| t.iter().map(TrialReport::from).collect()),
        groups: fitted.groups,
    };
    report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        report.run.items.iter().flat_map(|i| &i.warnings).for_each(|w| say::warning(w));
        report.stages.iter().for_each(|t| say::line(&t.line()));
        report.poses.iter().flat_map(poses::PoseReport::lines).for_each(|l| say::line(&l));
        tell_laws(law);
        fitted.trials.iter().flatten().for_each(tell_trial);
        report.groups.iter().for_each(|g| say::line(&g.line()));
        let laws = say::counted(law.laws.len() as u64, "law", "laws");
        say::line(&format!("{}: {laws}", args.output.display()));
    }
    Ok(())
}

fn fit_scans(args: &FitArgs, outputs: &mut Outputs, machine: &Machine) -> Outcome<Fitted> {
    let options = ["plant", "size", "by", "dates", "sheet"];
    args.given.refuse(&options, "growth tables", "scans are fitted")?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    let (loaded, read_ms) = machine.timed(|| {
        machine.with_progress("scans", |_| stages::load(&args.input, &axes, Seed::new(args.seed), machine))
    });
    let loaded = loaded?;
    outputs.check()?;
    let spec = LawSpec { regions: args.regions as usize, ..LawSpec::default() };
    let compute = machine.run();
    let (made, fit_ms) = machine.timed(|| {
        machine.with_progress("registration", |_| {
            let settled = bloom::settle(&loaded.stages, &RegisterSpec::default(), &compute)?;
            let law = bloom::fit_stages(&loaded.name, &settled.stages, &spec, &compute)?;
            Ok((settled, law))
        })
    });
    let (settled, law) = made.map_err(Failure::bloom(&args.input))?;
    if law.laws.is_empty() {
        return Err(Failure::bad_file(
            &args.input,
            "no organ is there on 3 days; label organs by hand (organ = \"leaf-1\") or add stages",
        ));
    }
    let trials = args.leave_one_out.then(|| {
        machine.with_progress("leave one out", |_| {
            let has_stems = loaded.stages.iter().all(|s| s.organs.iter().any(|o| o.name == "stem"));
            let up = (loaded.is_named_alike && has_stems).then_some(DVec3::Y);
            bloom::leave_one_out(&loaded.stages, &spec, &MotionSpec::default(), up, &compute)
        })
    });
    let mut warnings = loaded.warnings;
    warnings.extend(poses::doubts(&settled.steps));
    Ok(Fitted {
        law,
        warnings,
        offset_m: loaded.origin.offset_in(&loaded.axes),
        stages: loaded.told,
        poses: settled.steps.iter().map(poses::PoseReport::from).collect(),
        trials: trials.transpose().map_err(Failure::bloom(&args.input))?,
        read_ms,
        fit_ms,
        groups: None,
    })
}

fn tell_laws(law: &GrowthLaw) {
    let time = law.time.word();
    for l in &law.laws {
        let mm = |x: f64| format!("{:.3} mm", x * 1e3);
        let error = |x: Option<f64>| x.map_or_else(|| "unknown".to_owned(), mm);
        let what = format!("{} region {} {}", l.organ, l.region, l.axis.word());
        let rivals = format!(
            "each {time} predicted by the others: {} off, by a straight line {}, by the {time} before {}",
            error(l.loo_rmse),
            error(l.straight_rmse),
            error(l.last_rmse)
        );
        if l.is_determined() {
            let plus_minus = |e: f64| format!(" ± {e:.3}");
            let [last, first] =
                l.value_errors.map_or_else(Default::default, |e| e.map(|e| plus_minus(e * 1e3)));
            let rate = l.standard_errors.map_or_else(String::new, |e| plus_minus(e[2]));
            let end = l.final_value().map_or_else(
                || "no end that these days tell of".to_owned(),
                |end| format!("{:.3}{last} mm at the end", end * 1e3),
            );
            say::line(&format!(
                "{what}: {}, {:.3}{first} mm on {time} {}, {end}, r {:.4}{rate} a {time}, R2 {:.3}; {rivals}",
                l.form.word(),
                l.value(0.0) * 1e3,
                law.first_day,
                l.law.r,
                l.r2
            ));
        } else {
            let change = (l.value(law.span_days) - l.value(0.0)) * 1e3;
            let baseline = match l.form {
                Form::Still => "the last value",
                _ => "a straight line",
            };
            say::line(&format!(
                "{what}: {} {time}s determine no law; {baseline} is the best guess: {:.3} mm and {change:+.3} mm by the last {time}; {rivals}",
                l.days.len(),
                l.value(0.0) * 1e3
            ));
        }
    }
}

fn tell_trial(t: &Trial) {
    let end = if t.extrapolated { ", an end day: extrapolated" } else { "" };
    let law = if t.law { "" } else { "; the other days determine no law" };
    say::line(&format!("day {} left out{end}{law}; mean mm, scan to model / model to scan:", t.day));
    for (rival, row) in Rival::ALL.iter().zip(&t.rows) {
        let pair = |e: &ShapeError| format!("{:.2} / {:.2}", e.to_model.mean * 1e3, e.to_scan.mean * 1e3);
        let (aligned, scanner) = (pair(&row.aligned), pair(&row.scanner));
        say::line(&format!("  {:<23} aligned {aligned}, as it stands {scanner}", rival.word()));
    }
}

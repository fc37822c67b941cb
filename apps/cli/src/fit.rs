//! `burgeon bloom fit`: growth laws from scans of several days.

use burgeon::bloom::{self, GrowthLaw, LawSpec, Quantity};
use burgeon::{RunReport, Seed};
use serde::Serialize;

use crate::args::FitArgs;
use crate::failure::{Failure, Outcome};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::stages;
use crate::{files, report, say};

/// A law as the report tells it, lengths in metres.
#[derive(Debug, Serialize)]
struct LawReport {
    organ: String,
    region: usize,
    axis: Quantity,
    #[serde(rename = "K")]
    k: f64,
    p0: f64,
    r: f64,
    offset: f64,
    standard_errors: Option<[f64; 3]>,
    r2: f64,
    r2_adjusted: Option<f64>,
    loo_rmse: Option<f64>,
    /// On a bound of the search: the series determines no logistic.
    on_bound: bool,
}

/// What `fit` adds to the report.
#[derive(Debug, Serialize)]
struct FitReport {
    #[serde(flatten)]
    run: RunReport,
    laws: Vec<LawReport>,
    stages: Vec<stages::Told>,
}

pub(crate) fn fit(args: &FitArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = [
        ("-o", Some(&args.output)),
        ("--plot", args.plot.as_ref()),
        ("--report", args.common.report.as_ref()),
    ];
    let mut outputs = Outputs::new(&outputs, &[&args.input])?;
    let axes = files::axes(args.axes.up, args.axes.unit);
    let (loaded, read_ms) = machine.timed(|| {
        machine.with_progress("scans", |_| stages::load(&args.input, &axes, Seed::new(args.seed), &machine))
    });
    let loaded = loaded?;
    outputs.check()?;
    let spec = LawSpec { regions: args.regions as usize, ..LawSpec::default() };
    let (law, fit_ms) = machine.timed(|| bloom::fit_stages(&loaded.name, &loaded.stages, &spec));
    let law = law.map_err(Failure::bloom(&args.input))?;
    if law.laws.is_empty() {
        return Err(Failure::at(
            &args.input,
            "no organ is there on 3 days; label organs by hand (organ = \"leaf-1\") or add stages",
        ));
    }
    let text = serde_json::to_string_pretty(&law)
        .map_err(|e| Failure::Bug(format!("the law cannot be written as JSON: {e}")))?;
    let (written, write_ms) = machine.timed(|| {
        outputs.write("-o", &args.output, |out| Ok(writeln!(out, "{text}")?))?;
        match &args.plot {
            Some(plot) => {
                let svg = bloom::plot_svg(&law);
                outputs.write("--plot", plot, |out| Ok(out.write_all(svg.as_bytes())?))
            }
            None => Ok(()),
        }
    });
    written?;
    let mut run =
        report::of_one("bloom fit", args.seed, &args.input.display().to_string(), &law.name, &args.output);
    run.input.offset_m = loaded.origin.told(&loaded.axes);
    if let Some(item) = run.items.first_mut() {
        item.timings_ms.structure = fit_ms;
        item.timings_ms.add_io(read_ms, write_ms);
        item.timings_ms.total = machine.whole_ms();
        item.warnings.clone_from(&loaded.warnings);
    }
    let laws = law.laws.iter().map(|l| LawReport {
        organ: l.organ.clone(),
        region: l.region,
        axis: l.axis,
        k: l.law.k,
        p0: l.law.p0,
        r: l.law.r,
        offset: l.law.offset,
        standard_errors: l.standard_errors,
        r2: l.r2,
        r2_adjusted: l.r2_adjusted,
        loo_rmse: l.loo_rmse,
        on_bound: l.law.on_bound(law.span_days),
    });
    let report = FitReport { run, laws: laws.collect(), stages: loaded.told };
    report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        loaded.warnings.iter().for_each(|w| say::warning(w));
        report.stages.iter().for_each(|t| say::line(&t.line()));
        tell_laws(&law);
        say::line(&format!("{}: {} laws", args.output.display(), law.laws.len()));
    }
    Ok(())
}

fn tell_laws(law: &GrowthLaw) {
    for l in &law.laws {
        say::line(&format!(
            "{} region {} {}: K {:.3} mm, p0 {:.3} mm, r {:.4} a day, R2 {:.3}{}{}",
            l.organ,
            l.region,
            l.axis.word(),
            l.law.k * 1e3,
            l.law.p0 * 1e3,
            l.law.r,
            l.r2,
            l.loo_rmse.map_or(String::new(), |e| format!(", leave-one-out {:.3} mm", e * 1e3)),
            if l.law.on_bound(law.span_days) {
                " (on a bound: these days determine no logistic)"
            } else {
                ""
            }
        ));
    }
}

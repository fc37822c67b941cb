//! `burgeon bloom at`: the values of a law on any day.

use burgeon::Warning;
use burgeon::bloom::{Form, GrowthLaw, Quantity, RegionLaw};
use burgeon::{Report, RunReport, TimeUnit};
use serde::Serialize;

use crate::args::BloomAtArgs;
use crate::failure::Outcome;
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{report, say};

#[derive(Debug, Serialize)]
struct Row {
    day: f64,
    organ: String,
    region: usize,
    axis: Quantity,
    form: Form,
    determined: bool,
    /// Whether the day is before the first or after the last measured one.
    extrapolated: bool,
    value_m: f64,
    /// Bounds between which 9 of 10 new measurements lie.
    low_m: Option<f64>,
    high_m: Option<f64>,
}

impl Row {
    fn new(day: f64, since: f64, law: &RegionLaw) -> Self {
        let said = law.predict(since);
        let ends = law.days.first().zip(law.days.last());
        Self {
            day,
            organ: law.organ.clone(),
            region: law.region,
            axis: law.axis,
            form: law.form,
            determined: law.is_determined(),
            extrapolated: ends.is_some_and(|(first, last)| !(*first..=*last).contains(&since)),
            value_m: said.value,
            low_m: said.interval.map(|i| i[0]),
            high_m: said.interval.map(|i| i[1]),
        }
    }

    fn line(&self, time: TimeUnit) -> String {
        let interval = match (self.low_m, self.high_m) {
            (Some(low), Some(high)) => format!(" ({:.3} to {:.3})", 1e3 * low, 1e3 * high),
            _ => " (too few days for an interval)".to_owned(),
        };
        let doubt = match (self.determined, self.extrapolated) {
            (false, _) => format!(", not determined: {}", self.form.word()),
            (true, true) => ", beyond the days that were measured".to_owned(),
            (true, false) => String::new(),
        };
        let (organ, region, axis) = (&self.organ, self.region, self.axis.word());
        format!(
            "{} {}: {organ} region {region} {axis} {:.3} mm{interval}{doubt}",
            time.word(),
            self.day,
            1e3 * self.value_m
        )
    }
}

#[derive(Debug, Serialize)]
struct AtReport {
    #[serde(flatten)]
    run: RunReport,
    values: Vec<Row>,
}

pub(super) fn tell_days(args: &BloomAtArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs = Outputs::new(&[("--report", args.common.report.as_ref())], &[&args.input])?;
    let law = super::read_law(&args.input)?;
    let values: Vec<Row> = args
        .day
        .iter()
        .flat_map(|&day| law.laws.iter().map(move |l| (day, l)))
        .map(|(day, l)| Row::new(day, day - law.first_day, l))
        .collect();
    let mut run = RunReport::new("bloom at", 1);
    run.input.path = args.input.display().to_string();
    run.warnings = doubts(&law, &values).warnings.iter().map(Warning::to_string).collect();
    run.ok = 1;
    let whole = AtReport { run, values };
    report::finish(&whole, &args.common, outputs)?;
    if !machine.quiet {
        whole.run.warnings.iter().for_each(|w| say::warning(w));
        whole.values.iter().for_each(|row| say::line(&row.line(law.time)));
    }
    Ok(())
}

/// Warns of values that are not to be trusted.
fn doubts(law: &GrowthLaw, values: &[Row]) -> Report {
    let mut out = Report::default();
    let open = values.iter().filter(|v| !v.determined).count();
    if open > 0 {
        let all = values.len();
        out.warn(
            "laws-undetermined",
            format!(
                "{open} of {all} values are of laws that their days do not determine: measure on more days"
            ),
        );
    }
    let [first, last] = [law.first_day, law.first_day + law.span_days];
    if values.iter().any(|v| v.extrapolated) {
        out.warn(
            "day-beyond",
            format!("the law was measured from day {first} to {last}: beyond, nothing says that growth goes on as it did"),
        );
    }
    out
}

//! Growth laws of a growth table: one for each organ of each plant, or one for each group of plants.

use std::collections::BTreeMap;

use burgeon::bloom::{self, GroupTest, GrowthLaw, Offset, PlantGroup, Series};
use burgeon::formats::{GrowthEntry, GrowthSpec, ReadGrowth, read_growth, read_xlsx};
use burgeon::{Seed, Warning};
use serde::Serialize;

use crate::args::FitArgs;
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::machine::Machine;
use crate::say;

/// Laws of a growth table.
pub(crate) struct TableFit {
    pub(crate) law: GrowthLaw,
    pub(crate) warnings: Vec<String>,
    /// Whether groups grow alike, if there are groups.
    pub(crate) groups: Option<GroupReport>,
    pub(crate) read_ms: f64,
    pub(crate) fit_ms: f64,
}

/// Whether groups grow alike, in the report.
#[derive(Debug, Serialize)]
pub(crate) struct GroupReport {
    by: String,
    groups: Vec<String>,
    /// Sums of squares of one curve for all, and of a curve for each, square metres.
    squares_m2: [f64; 2],
    freedom: [u32; 2],
    f: f64,
    /// Probability if all values were independent.
    p_f: f64,
    permutations: Option<u32>,
    /// Probability by permutations of the groups of plants; null for too few.
    p_permuted: Option<f64>,
}

impl GroupReport {
    fn new(by: &str, groups: &[PlantGroup], test: &GroupTest) -> Self {
        Self {
            by: by.to_owned(),
            groups: groups.iter().map(|g| g.name.clone()).collect(),
            squares_m2: test.squares,
            freedom: test.freedom,
            f: test.f,
            p_f: test.p,
            permutations: test.permuted.map(|p| p.times),
            p_permuted: test.permuted.map(|p| p.p),
        }
    }

    pub(crate) fn line(&self) -> String {
        let permuted = self.p_permuted.map_or_else(
            || {
                "; too few plants to exchange among groups, so p holds for values that are independent alone"
                    .to_owned()
            },
            |p| {
                format!(
                    ", p = {p:.3} where plants change their groups, which counts values of one plant once"
                )
            },
        );
        let alike = self.p_permuted.unwrap_or(self.p_f) >= 0.05;
        let verdict = if alike { "one curve may do for all" } else { "they grow apart" };
        let [d1, d2] = self.freedom;
        format!(
            "{} groups by {}: {verdict}; F({d1}, {d2}) = {:.2}, p = {:.4}{permuted}",
            self.groups.len(),
            self.by,
            self.f,
            self.p_f
        )
    }
}

/// Fits the laws of a growth table.
pub(crate) fn fit(args: &FitArgs, machine: &Machine) -> Outcome<TableFit> {
    let this = "a growth table has neither parts nor shapes";
    args.given.refuse(&["regions", "leave_one_out", "up"], "scans", this)?;
    args.given.only_if(
        args.table.by.is_some(),
        &["seed"],
        "scans and groups (--by)",
        "nothing is random here",
    )?;
    let (read, read_ms) = machine.timed(|| read(args));
    let read = read?;
    let time = read.time;
    let warnings = read.warnings.iter().map(ToString::to_string).collect();
    let mut fitted = match &args.table.by {
        Some(by) => fit_groups(args, by, read.rows, machine)?,
        None => fit_plants(args, read.rows, machine)?,
    };
    fitted.law.time = time;
    fitted.warnings = [warnings, fitted.warnings].concat();
    fitted.read_ms = read_ms;
    Ok(fitted)
}

fn read(args: &FitArgs) -> Outcome<ReadGrowth> {
    let (path, table) = (&args.input, &args.table);
    let input = files::open_bytes(path)?;
    let spec = GrowthSpec {
        unit: args.axes.unit,
        plant: table.plant.clone(),
        size: table.size.clone(),
        by: table.by.clone(),
        dates: table.dates,
    };
    let is_workbook = files::extension(path).is_some_and(|e| e.eq_ignore_ascii_case("xlsx"));
    args.given.only_if(is_workbook, &["sheet"], "workbooks (.xlsx)", "the table is none")?;
    let failed = |e| Failure::bad_file(path, e);
    let mut read = if is_workbook {
        let sheet = read_xlsx(input, table.sheet.as_deref()).map_err(failed)?;
        let mut read = read_growth(sheet.text.as_bytes(), &spec).map_err(failed)?;
        if table.sheet.is_none() && !sheet.others.is_empty() {
            let others = sheet.others.join(", ");
            let message =
                format!("the sheet \"{}\" was read, and not {others}: --sheet names another", sheet.name);
            read.warnings.push(Warning { code: "sheets-left-out", message, fields: Vec::new() });
        }
        read
    } else {
        read_growth(input, &spec).map_err(failed)?
    };
    if read.unit.is_none() && !args.given.has("unit") {
        let most = read.rows.iter().map(|r| r.size).fold(0.0, f64::max);
        read.warnings.push(Warning {
            code: "unit-taken",
            message: format!(
                "no unit is said: sizes were taken for metres, the largest for {most} m. Write a line `# unit: mm`, put the unit \
                 into the heading (height_cm), or say --unit"
            ),
            fields: Vec::new(),
        });
    }
    Ok(read)
}

/// Returns the name of a plant, or of an organ of it.
fn name_of(row: &GrowthEntry) -> String {
    match (row.organ.is_empty(), row.plant.is_empty()) {
        (true, true) => "plant".to_owned(),
        (false, true) => row.organ.clone(),
        // The number comes last: the text before it is the kind.
        (true, false) => format!("plant {}", row.plant),
        (false, false) => format!("plant {}: {}", row.plant, row.organ),
    }
}

/// Collects values by name, in the order of the table.
fn gathered(rows: &[GrowthEntry], name: impl Fn(&GrowthEntry) -> String) -> Vec<(String, Vec<(f64, f64)>)> {
    let mut series: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows {
        let place = *places.entry(name(row)).or_insert_with_key(|name| {
            series.push((name.clone(), vec![]));
            series.len() - 1
        });
        series[place].1.push((row.day, row.size));
    }
    series
}

/// Fits a law for each organ of each plant.
fn fit_plants(args: &FitArgs, rows: Vec<GrowthEntry>, machine: &Machine) -> Outcome<TableFit> {
    let mut warnings = Vec::new();
    let mut able = Vec::new();
    for (name, mut rows) in gathered(&rows, name_of) {
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(twice) = rows.windows(2).find(|w| w[0].0 >= w[1].0) {
            let line = format!(
                "{name} has two sizes on day {}; give one, name the column that tells plants apart (--plant COLUMN), or the one \
                 of groups of plants (--by COLUMN)",
                twice[0].0
            );
            return Err(Failure::bad_file(&args.input, line));
        }
        if rows.len() < 3 {
            let sizes = say::counted(rows.len() as u64, "size", "sizes");
            warnings.push(format!("{name} has {sizes}: a law needs 3"));
        }
        let (days, values) = rows.into_iter().unzip();
        able.push((name, Series { days, values }));
    }
    let (law, fit_ms) =
        machine.timed(|| bloom::fit_sizes(&files::stem(&args.input), &able, Offset::Auto, &machine.run()));
    let law = law.map_err(Failure::bloom(&args.input))?;
    Ok(TableFit { law, warnings, groups: None, read_ms: 0.0, fit_ms })
}

/// Fits a law for each group of plants.
fn fit_groups(args: &FitArgs, by: &str, rows: Vec<GrowthEntry>, machine: &Machine) -> Outcome<TableFit> {
    let mut warnings = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|r| !r.group.is_empty()) {
        if !names.contains(&row.group.as_str()) {
            names.push(&row.group);
        }
        if names.len() > MOST_GROUPS {
            let line =
                format!("the column {by} tells more than {MOST_GROUPS} groups; name another with --by");
            return Err(Failure::bad_file(&args.input, line));
        }
    }
    let without = rows.iter().filter(|r| r.group.is_empty()).count();
    if without > 0 {
        warnings.push(format!("{without} sizes have no group ({by}) and were left out"));
    }
    let mut groups = Vec::new();
    for name in names {
        let own: Vec<GrowthEntry> = rows.iter().filter(|r| r.group == name).cloned().collect();
        let mut days: Vec<f64> = own.iter().map(|r| r.day).collect();
        days.sort_by(f64::total_cmp);
        days.dedup();
        if days.len() < 3 {
            let days = say::counted(days.len() as u64, "day", "days");
            warnings.push(format!("the group {name} was measured on {days} and left out: a curve needs 3"));
            continue;
        }
        let plants = gathered(&own, name_of).into_iter().map(|(_, pairs)| {
            let (days, values) = pairs.into_iter().unzip();
            Series { days, values }
        });
        groups.push(PlantGroup { name: name.to_owned(), plants: plants.collect() });
    }
    if groups.is_empty() {
        return Err(Failure::bad_file(
            &args.input,
            format!("no group by {by} was measured on 3 days or more"),
        ));
    }
    let seed = Seed::new(args.seed);
    let (found, fit_ms) =
        machine.timed(|| bloom::fit_groups(&files::stem(&args.input), &groups, seed, &machine.run()));
    let found = found.map_err(Failure::bloom(&args.input))?;
    if groups.len() == 1 {
        warnings.push(format!("there is one group by {by}: nothing is compared"));
    }
    let report = found.test.map(|test| GroupReport::new(by, &groups, &test));
    Ok(TableFit { law: found.law, warnings, groups: report, read_ms: 0.0, fit_ms })
}

/// Most groups that are compared: a column with more values has another meaning.
const MOST_GROUPS: usize = 100;

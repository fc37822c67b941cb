//! `burgeon species fit`: measured trees to a species.

use std::path::Path;

use burgeon::formats::StructureSpec;
use burgeon::growth::{
    Agreement, FittedSpecies, SpeciesLimits, Trait, Traits, Unfitted, agree, fit_species, grow,
};
use burgeon::plant::Plant;
use burgeon::{Report, RunReport, Seed, TreeSpec, Warning, read_tree_spec};
use serde::Serialize;

use crate::args::{SpeciesCommand, SpeciesFitArgs};
use crate::failure::{Failure, Outcome};
use crate::files::Kind;
use crate::machine::Machine;
use crate::output::Outputs;
use crate::species_plot::picture_of;
use crate::{files, picture, report, say, structure};

pub(crate) fn species(command: &SpeciesCommand) -> Outcome {
    match command {
        SpeciesCommand::Fit(args) => fit(args),
    }
}

/// Least number of trees from which some are kept out of the fit, and the step between these.
const KEPT_OUT: (usize, usize) = (6, 3);
/// Probability below which a greater distance by chance means that the trees differ.
const DIFFERENT: f64 = 0.05;
/// Most trees in memory that are grown before their traits are measured.
const AT_ONCE: usize = 16;

/// One trait of one order, in the report.
#[derive(Debug, Serialize)]
struct TraitReport {
    order: usize,
    name: &'static str,
    unit: &'static str,
    /// Number of values of the fitted trees.
    count: usize,
    median: f64,
    /// Interval at 90 %, by the ranks of values round the middle.
    median_interval: [f64; 2],
    /// Comparison of grown trees with fitted ones, and with those kept out; null where one of them lacks the trait.
    fitted: Option<Compared>,
    kept_out: Option<Compared>,
}

/// Comparison of two distributions.
#[derive(Clone, Copy, Debug, Serialize)]
struct Compared {
    /// Numbers of values of the measured, and of the grown trees.
    counts: [usize; 2],
    medians: [f64; 2],
    /// Greatest distance between the distributions.
    distance: f64,
    /// Probability of the test of Kolmogorov and Smirnov.
    p: f64,
}

impl From<&Agreement> for Compared {
    fn from(a: &Agreement) -> Self {
        Self { counts: a.counts, medians: a.medians, distance: a.distance, p: a.p }
    }
}

#[derive(Debug, Serialize)]
struct SpeciesReport {
    #[serde(flatten)]
    run: RunReport,
    trees_fitted: usize,
    trees_kept_out: usize,
    trees_grown: u32,
    traits: Vec<TraitReport>,
}

/// Measured trees, and those of the spec.
struct Measured {
    fitted: Traits,
    kept_out: Traits,
    grown: Traits,
}

impl Measured {
    fn rows(&self, orders: usize) -> Vec<TraitReport> {
        let [fitted, kept_out] = [&self.fitted, &self.kept_out].map(|lot| agree(lot, &self.grown, orders));
        let mut out = Vec::new();
        for (order, traits) in self.fitted.orders.iter().enumerate().take(orders) {
            for which in Trait::ALL.into_iter().filter(|t| t.is_of(order)) {
                let mut values = traits.values(which).to_vec();
                if values.is_empty() {
                    continue;
                }
                values.sort_by(f64::total_cmp);
                let of = |rows: &[Agreement]| {
                    rows.iter().find(|a| a.order == order && a.which == which).map(Compared::from)
                };
                let [low, median, high] = median_of(&values);
                out.push(TraitReport {
                    order,
                    name: which.word(),
                    unit: which.unit(),
                    count: values.len(),
                    median,
                    median_interval: [low, high],
                    fitted: of(&fitted),
                    kept_out: of(&kept_out),
                });
            }
        }
        out
    }
}

/// Returns the median of sorted values, with the bounds of its interval at 90 % (binomial ranks).
fn median_of(sorted: &[f64]) -> [f64; 3] {
    let n = sorted.len() as f64;
    let half = 0.5 * 1.645 * n.sqrt();
    let at = |rank: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the last rank")]
        let low = rank.clamp(0.0, n - 1.0) as usize;
        sorted[low]
    };
    [at((0.5 * n - half).floor()), at(0.5 * (n - 1.0)), at((0.5 * n + half).ceil())]
}

fn fit(args: &SpeciesFitArgs) -> Outcome {
    let machine = Machine::new(&args.common);
    let outputs =
        [("-o", Some(&args.output)), ("--png", args.png.as_ref()), ("--report", args.common.report.as_ref())];
    let mut outputs = Outputs::new(&outputs, &args.inputs.iter().collect::<Vec<_>>())?;
    if files::extension(&args.output).is_none_or(|e| !e.eq_ignore_ascii_case("toml")) {
        return Err(Failure::bad_file(&args.output, "a species is written as TOML: name a file .toml"));
    }
    if let Some(png) = &args.png {
        picture::check_name(png)?;
    }
    let mut told = Report::default();
    let (plants, read_ms) = machine.timed(|| read(args, &mut told, &machine));
    let plants = plants?;
    if args.keep_none_out && plants.len() < KEPT_OUT.0 {
        let line = "--keep-none-out is for six trees or more; of fewer all are fitted: leave it out";
        return Err(Failure::Bad(line.into()));
    }
    let keeps = !args.keep_none_out && plants.len() >= KEPT_OUT.0;
    let is_kept_out = |k: usize| keeps && k % KEPT_OUT.1 == KEPT_OUT.1 - 1;
    let lot = |kept: bool| {
        let own = plants.iter().enumerate().filter(|(k, _)| is_kept_out(*k) == kept);
        (own.clone().count(), Traits::measure(own.map(|(_, p)| p)))
    };
    let [(trees_fitted, fitted), (trees_kept_out, kept_out)] = [lot(false), lot(true)];
    // Removes characters that TOML does not hold unescaped.
    let name: String = files::stem(&args.output).chars().filter(|c| !c.is_control()).collect();
    let species =
        fit_species(&name, &fitted, &SpeciesLimits::default()).map_err(|e| Failure::Bad(e.to_string()))?;
    let (grown, grow_ms) = machine.timed(|| grown(&species.spec, args.trees, &machine));
    let measured = Measured { fitted, kept_out, grown: grown? };
    let traits = measured.rows(species.orders);
    warn(&species, &traits, keeps, &mut told);
    let text = toml_of(&species.spec)?;
    outputs.write("-o", &args.output, |out| Ok(out.write_all(text.as_bytes())?))?;
    if let Some(png) = &args.png {
        let lots = [&measured.fitted, &measured.kept_out, &measured.grown];
        let drawn =
            picture_of(lots, &agree(&measured.fitted, &measured.grown, species.orders), species.orders);
        picture::write(&mut outputs, "--png", png, &drawn)?;
    }
    let first = args.inputs[0].display().to_string();
    let mut run = report::report_one("species fit", 1, &first, &name, &args.output);
    if let Some(item) = run.items.first_mut() {
        item.timings_ms.add_io(read_ms, 0.0);
        item.timings_ms.structure = grow_ms;
        item.timings_ms.total = machine.whole_ms();
        item.warnings = told.warnings.iter().map(Warning::to_string).collect();
    }
    let report = SpeciesReport { run, trees_fitted, trees_kept_out, trees_grown: args.trees, traits };
    report::finish(&report, &args.common, outputs)?;
    if !machine.quiet {
        report.run.items.iter().flat_map(|i| &i.warnings).for_each(|w| say::warning(w));
        report.traits.iter().for_each(|t| say::line(&line(t)));
        say::line(&format!(
            "{}: {} orders of {trees_fitted} trees, {trees_kept_out} kept out, {} grown",
            args.output.display(),
            species.orders,
            args.trees
        ));
    }
    Ok(())
}

fn read(args: &SpeciesFitArgs, told: &mut Report, machine: &Machine) -> Outcome<Vec<Plant>> {
    let spec = StructureSpec {
        up: None,
        metres: args.in_unit.map(|u| u.metres),
        thickness_metres: args.thickness_unit.map(|u| u.metres),
    };
    let mut plants = Vec::new();
    for path in &args.inputs {
        machine.cancel.check()?;
        let (input, Kind::Structure(format)) = files::open(path)? else {
            return Err(Failure::bad_file(
                path,
                "is no structure of trees (a table of cylinders, MTG, OPF or SWC)",
            ));
        };
        let mut own = Report::default();
        let read = structure::read(path, input, format, &spec, &mut own)?.plants;
        read.iter().try_for_each(|plant| structure::check_height(path, plant))?;
        plants.extend(read);
        told.warnings.extend(own.warnings.into_iter().map(|w| named(path, w)));
    }
    Ok(plants)
}

fn named(path: &Path, warning: Warning) -> Warning {
    Warning { message: format!("{}: {}", path.display(), warning.message), ..warning }
}

/// Returns the traits of trees of the spec, of seeds from 1 on.
fn grown(spec: &TreeSpec, trees: u32, machine: &Machine) -> Outcome<Traits> {
    let bare = TreeSpec { bare: true, ..spec.clone() };
    let run = machine.run();
    let seeds: Vec<u64> = (1..=u64::from(trees)).collect();
    let mut out = Traits::default();
    for some in seeds.chunks(AT_ONCE) {
        let made = burgeon::map_indexed(run.executor, some.len(), |k| {
            grow(&bare, None, Seed::new(some[k]), &burgeon::Run::plain(), &mut Report::default())
        });
        machine.cancel.check()?;
        for tree in made {
            let tree = tree.map_err(|e| {
                Failure::Bad(format!(
                    "a tree of the fitted species cannot be grown: {e}; are the units right (--in-unit, --thickness-unit), and branches \
                     no longer than what bears them?"
                ))
            })?;
            out.add(&tree.plant);
        }
    }
    Ok(out)
}

fn warn(species: &FittedSpecies, traits: &[TraitReport], keeps: bool, told: &mut Report) {
    for unfitted in &species.unfitted {
        let (code, message) = match unfitted {
            Unfitted::Orders { from, axes } => (
                "species-orders",
                format!(
                    "order {from} has {axes} axes, too few to fit: trees of the species end with order {}",
                    from - 1
                ),
            ),
            Unfitted::Trunks { trees } => (
                "species-trunks",
                format!(
                    "of {trees} tree nothing tells how trees differ: all trunks are as long and thick; give more trees"
                ),
            ),
            Unfitted::Borne { most } => (
                "species-borne",
                format!("an axis bears {most} others, more than rules can make: those beyond are left out"),
            ),
        };
        told.warn(code, message);
    }
    if !keeps {
        told.warn(
            "species-unchecked",
            format!(
                "no tree was kept out, so that the agreement is with trees that were fitted; give {} or more",
                KEPT_OUT.0
            ),
        );
    }
    let differ: Vec<String> = traits
        .iter()
        .filter_map(|t| {
            let compared = t.kept_out.or(t.fitted)?;
            (compared.p < DIFFERENT).then(|| {
                format!(
                    "{} of order {} (p {:.4}, distance {:.2})",
                    t.name, t.order, compared.p, compared.distance
                )
            })
        })
        .collect();
    if !differ.is_empty() {
        let lot = if keeps { "kept out" } else { "fitted" };
        let message = format!(
            "{} of {} distributions of grown trees differ from those of the trees {lot}: {}",
            differ.len(),
            traits.len(),
            differ.join(", ")
        );
        told.warn("species-differs", message);
    }
    told.warn(
        "species-straight",
        "azimuths are even and axes straight: neither is fitted, nor are leaves, bark and how traits go together (long branches low \
         on a trunk); edit the spec for these",
    );
}

fn line(t: &TraitReport) -> String {
    let [low, high] = t.median_interval;
    let unit = if t.unit.is_empty() { String::new() } else { format!(" {}", t.unit) };
    let compared = |what: &str, c: Option<Compared>| {
        c.map_or_else(String::new, |c| {
            format!("; {what}: median {:.3}, distance {:.3}, p {:.3}", c.medians[1], c.distance, c.p)
        })
    };
    let against = t.kept_out.map(|c| format!(" ({} kept out, median {:.3})", c.counts[0], c.medians[0]));
    format!(
        "order {} {}: {} values, median {:.3} ({low:.3} to {high:.3}){unit}{}{}{}",
        t.order,
        t.name,
        t.count,
        t.median,
        compared("grown", t.fitted),
        compared("against trees kept out", t.kept_out),
        against.unwrap_or_default()
    )
}

/// Writes the spec as people edit it: omitted fields have their defaults.
fn toml_of(spec: &TreeSpec) -> Outcome<String> {
    let burgeon::growth::Method::Lsystem { rules, most_modules } = &spec.method else {
        return Err(Failure::Bug("a fitted species has no rules".into()));
    };
    let quoted = |text: &str| {
        // A string of JSON is also one of TOML.
        serde_json::to_string(text).map_err(|e| Failure::Bug(format!("a name cannot be written: {e}")))
    };
    let text = format!(
        "# Made by `burgeon species fit`. Leaves, bark and colours are not fitted: see `burgeon presets oak` for what can be said.\n\
         name = {}\nabout = {}\n\n[method]\nkind = \"lsystem\"\nmost_modules = {most_modules}\nrules = '''\n{rules}'''\n\n\
         # Axes as the rules draw them.\n[wood]\nsmooth = false\nrelax = 0\nthin_out = 0.0\n",
        quoted(&spec.name)?,
        quoted(&spec.about)?,
    );
    match read_tree_spec(&text, &|_| None) {
        Ok(read) if read == *spec => Ok(text),
        Ok(_) => Err(Failure::Bug("the species is another when read again".into())),
        Err(e) => Err(Failure::Bug(format!("the species cannot be read again: {e}"))),
    }
}

//! Files of leaves for `burgeon leaf` and --leaf-template: marks, chief veins, vein graphs and profiles.

use std::path::Path;

use burgeon::formats::Room;
use burgeon::formats::{LeafFile, MarksAxes, ReadGraph, ReadMarks, ReadProfiles, ReadRays, read_leaf_file};
use burgeon::leaf::{LeafForm, Marks, Rays, ThicknessRule};
use burgeon::{LeafError, LeafOptions, LeafTemplate, Report, Seed, Unit, Warning};

use crate::args::AxesArgs;
use crate::args::Given;
use crate::args::{GraphWord, LeafArgs, ThicknessWord};
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::inputs;
use crate::machine::Machine;

/// Stretch of the places of widths, as a share of the leaf, above which it is reported: widths are read off about so
/// precisely.
const STRETCH_TOLD: f64 = 0.03;
/// Number of places on each vein of a profile: a span of 5 % of the leaf between two.
const PROFILE_MARKS: usize = 21;

/// One leaf as read.
pub(crate) struct ReadLeaf {
    pub(crate) name: String,
    pub(crate) form: Form,
    /// Meaning of thickness, where the file gives it.
    pub(crate) thickness: Option<ThicknessRule>,
    pub(crate) warnings: Vec<Warning>,
}

/// Form of the veins of a leaf.
pub(crate) enum Form {
    /// Side veins along one midrib.
    Rows(Marks),
    /// Chief veins with a common start.
    Rays(Rays),
}

/// Options for reading files.
struct Asked<'a> {
    axes: MarksAxes,
    length_m: Option<f64>,
    graph: GraphWord,
    /// Number of the leaf among several, from 1.
    number: Option<u32>,
    thickness: Option<ThicknessWord>,
    /// Whether the axes of the input are also those of the output.
    axes_written: bool,
    given: &'a Given,
}

/// Reads the leaf of one file with the settings of `args`.
pub(crate) fn read(path: &Path, args: &LeafArgs) -> Outcome<ReadLeaf> {
    let asked = Asked {
        axes: axes_of(&args.axes),
        length_m: args.length,
        graph: args.graph,
        number: args.number,
        thickness: args.shape.thickness,
        axes_written: args
            .output
            .as_deref()
            .is_some_and(|p| files::writable(p).is_ok_and(|f| f.holds(Room::Axes))),
        given: &args.given,
    };
    asked.read(path, files::open_bytes(path)?)
}

fn axes_of(args: &AxesArgs) -> MarksAxes {
    MarksAxes { unit: args.unit, up: args.up.unwrap_or_default() }
}

impl Asked<'_> {
    fn read(&self, path: &Path, input: files::Input) -> Outcome<ReadLeaf> {
        let name = files::stem(path);
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
            return self.form(path, name, input);
        }
        let read = read_leaf_file(input, &name, self.axes);
        let read = read.map_err(|e| Failure::bad_file(path, e))?;
        if !matches!(read, LeafFile::Graph(_)) {
            self.given.refuse(&["graph", "length"], "vein graphs", "this leaf has measured lengths")?;
        }
        if !matches!(read, LeafFile::Profiles(_)) {
            self.given.refuse(&["number"], "files of several leaves (profiles)", "this file holds one")?;
        }
        match read {
            LeafFile::Marks(read) => self.marks(path, read),
            LeafFile::Rays(read) => self.rays(path, read),
            LeafFile::Graph(read) => self.graph(path, name, read),
            LeafFile::Profiles(read) => self.profile(path, read),
            _ => Err(Failure::Bug("a file of a leaf is of a new kind".into())),
        }
    }

    /// Makes a leaf from numbers.
    fn form(&self, path: &Path, name: String, mut input: files::Input) -> Outcome<ReadLeaf> {
        let others = ["graph", "length", "number", "thickness", "up", "unit"];
        self.given.refuse(&others, "measured leaves", "a form says its own numbers")?;
        let mut text = String::new();
        input.read_to_string(&mut text).map_err(|e| Failure::io(path, "read", &e))?;
        let form: LeafForm = burgeon::spec::from_toml(&text).map_err(|e| Failure::bad_file(path, e))?;
        let thickness = Some(ThicknessRule::Diameter);
        Ok(ReadLeaf { name, form: Form::Rows(form.marks()), thickness, warnings: Vec::new() })
    }

    fn marks(&self, path: &Path, read: ReadMarks) -> Outcome<ReadLeaf> {
        self.agree(path, read.axes, read.thickness)?;
        let ReadMarks { name, marks, thickness, mut warnings, is_unit_said, .. } = read;
        warnings.extend(self.unit_taken(is_unit_said, marks.length()));
        Ok(ReadLeaf { name, form: Form::Rows(marks), thickness, warnings })
    }

    fn rays(&self, path: &Path, read: ReadRays) -> Outcome<ReadLeaf> {
        self.agree(path, read.axes, read.thickness)?;
        let ReadRays { name, rays, thickness, is_unit_said, .. } = read;
        let warnings = self.unit_taken(is_unit_said, rays.length()).into_iter().collect();
        Ok(ReadLeaf { name, form: Form::Rays(rays), thickness, warnings })
    }

    /// Returns a warning where neither the file nor the command line gives a unit.
    fn unit_taken(&self, is_said: bool, length: f64) -> Option<Warning> {
        let message = || {
            format!(
                "no unit is said: lengths were taken for metres, and the leaf is {length:.4} m long. Write a line `# unit: mm`, or \
                 say --unit"
            )
        };
        let is_taken = !is_said && !self.given.has("unit");
        is_taken.then(|| Warning { code: "unit-taken", message: message(), fields: Vec::new() })
    }

    /// Checks that the statements of a file, which override assumptions, do not contradict the options.
    fn agree(&self, path: &Path, axes: MarksAxes, thickness: Option<ThicknessRule>) -> Outcome {
        let rule = |rule: ThicknessRule| if rule == ThicknessRule::Radius { "radius" } else { "diameter" };
        let asked_rule = self.thickness.map(ThicknessRule::from);
        let differs = [
            ("unit", axes.unit != self.axes.unit, axes.unit.word(), self.axes.unit.word()),
            ("up", axes.up != self.axes.up, axes.up.word(), self.axes.up.word()),
            (
                "thickness",
                thickness.is_some() && asked_rule.is_some() && thickness != asked_rule,
                thickness.map_or("", rule),
                asked_rule.map_or("", rule),
            ),
        ];
        for (option, differs, file, asked) in differs {
            if differs && self.given.has(option) {
                let what = format_args!(
                    "says `# {option}: {file}`, --{option} says {asked}: correct the file or leave the option out"
                );
                return Err(Failure::bad_file(path, what));
            }
        }
        Ok(())
    }

    /// Makes a leaf of a vein graph: palmate where it is, else by its midrib.
    fn graph(&self, path: &Path, name: String, read: ReadGraph) -> Outcome<ReadLeaf> {
        let given = self.given;
        given.refuse(&["thickness"], "marks and chief veins", "a vein graph has radii")?;
        given.only_if(self.axes_written, &["up", "unit"], "other files", "a vein graph says them itself")?;
        let mut report = Report { warnings: read.warnings, ..Report::default() };
        let failed = |e| Failure::bad_file(path, e);
        let rays = match self.graph {
            GraphWord::Midrib => None,
            GraphWord::Auto | GraphWord::Palmate => read.graph.rays(&mut report).map_err(failed)?,
        };
        if rays.is_none() && self.graph == GraphWord::Palmate {
            let what = "no place is found that three or more thick veins leave; --graph midrib reads it as a leaf of one";
            return Err(Failure::bad_file(path, what));
        }
        if let Some(rays) = &rays {
            let veins = rays.rays.iter().filter(|r| r.is_vein()).count();
            let message = format!(
                "{veins} thick veins leave one place: read as palmate; --graph midrib reads one midrib"
            );
            report.warn("palmate", message);
        }
        let form = match rays {
            Some(rays) => Form::Rays(rays),
            None => Form::Rows(read.graph.marks(&mut report).map_err(failed)?),
        };
        let sized = read.unit.is_none() || self.length_m.is_some();
        if sized && self.length_m.is_none() {
            let message = "the graph is in pixels: the leaf was made 0.1 m long; say --length";
            report.warn("length-guessed", message);
        }
        let length = self.length_m.unwrap_or(0.1);
        let form = match form {
            Form::Rays(rays) if sized => {
                let factor = length / rays.length();
                Form::Rays(rays.scaled(factor))
            }
            Form::Rows(marks) if sized => Form::Rows(marks.scaled(length / marks.length())),
            other => other,
        };
        // A radius is not a reading of callipers, but its double is.
        Ok(ReadLeaf { name, form, thickness: Some(ThicknessRule::Diameter), warnings: report.warnings })
    }

    /// Returns the requested leaf of a file of profiles.
    fn profile(&self, path: &Path, read: ReadProfiles) -> Outcome<ReadLeaf> {
        let users = "files that do not say it themselves";
        self.given.only_if(self.axes_written, &["up"], users, "profiles have y upwards")?;
        self.given.refuse(&["thickness"], "marks and chief veins", "a profile has none")?;
        if read.axes.unit != self.axes.unit && self.given.has("unit") {
            return Err(Failure::bad_file(
                path,
                "says its unit itself: leave --unit out or correct the file",
            ));
        }
        let count = read.leaves.len();
        let mut report = Report::default();
        if count > 1 && self.number.is_none() {
            let message = format!(
                "the file holds {count} leaves: the first was made; --number 1 to {count} chooses one"
            );
            report.warn("first-leaf", message);
        }
        let number = self.number.unwrap_or(1);
        let Some(leaf) = read.leaves.into_iter().nth(number as usize - 1) else {
            return Err(Failure::bad_file(
                path,
                format_args!("holds {count} leaves; --number {number} is none of them"),
            ));
        };
        let mut rays = leaf.profile.rays(PROFILE_MARKS).map_err(|e| Failure::bad_file(path, e))?;
        report.warn(
            "veins-guessed",
            "a profile holds no veins: nine parallel ones were made, as thick as a lily's",
        );
        let stretch = leaf.profile.stretch();
        if (stretch - 1.0).abs() > STRETCH_TOLD {
            report.warn(
                "profile-stretched",
                format!(
                    "the midrib is {stretch:.2} times as long as the last place of a width is from the first: the places were \
                     stretched to it, and the area with them. Were all widths measured, from base to tip, in the midrib's unit?"
                ),
            );
        }
        // 10 m: no leaf is longer, and tables of maize are in centimetres.
        if rays.length() > 10.0 && !self.given.has("unit") && read.axes.unit == Unit::Metre {
            rays = rays.scaled(0.01);
            report.warn(
                "unit-guessed",
                "the leaf is more than 10 m long: it was taken for centimetres; say --unit cm",
            );
        } else {
            report.warnings.extend(self.unit_taken(read.is_unit_said, rays.length()));
        }
        Ok(ReadLeaf {
            name: leaf.name,
            form: Form::Rays(rays),
            thickness: Some(ThicknessRule::Diameter),
            warnings: report.warnings,
        })
    }
}

/// Makes a leaf for other makers' plants, from marks, chief veins or a profile (.csv, .json) or a model of a leaf.
pub(crate) fn template_of(path: &Path, seed: u64, machine: &Machine) -> Outcome<LeafTemplate> {
    let measured =
        files::extension(path).is_some_and(|e| ["csv", "json"].iter().any(|k| e.eq_ignore_ascii_case(k)));
    let axes = burgeon::formats::ExportSpec::default();
    let (input, model) = if inputs::is_stdin(path) {
        let (input, start) = files::peek(path)?;
        let kind = files::sniff(&start).filter(|kind| matches!(kind, files::Kind::Model(_)));
        (input, kind)
    } else if measured {
        (files::open_bytes(path)?, None)
    } else {
        let (input, kind) = files::open(path)?;
        (input, Some(kind))
    };
    if let Some(kind) = model {
        let (model, _, _) = files::read_opened_model(path, input, kind, &axes)?;
        return LeafTemplate::from_model(&model).map_err(|e| Failure::bad_file(path, e));
    }
    let given = Given::default();
    let asked = Asked {
        axes: MarksAxes::default(),
        length_m: None,
        graph: GraphWord::Auto,
        number: None,
        thickness: None,
        axes_written: false,
        given: &given,
    };
    let failed = |e| match e {
        LeafError::Cancelled(_) => Failure::Cancelled,
        other => Failure::bad_file(path, format_args!("{other}{}", way_out(&other))),
    };
    let read = asked.read(path, input)?;
    let mut options = LeafOptions::default();
    options.spec.thickness = read.thickness;
    match read.form {
        Form::Rows(marks) => {
            let full = marks.complete(&mut Report::default()).map_err(|e| Failure::bad_file(path, e))?;
            LeafTemplate::from_marks(&full, &options.look(), Seed::new(seed), &machine.run()).map_err(failed)
        }
        Form::Rays(rays) => {
            let made = LeafTemplate::from_rays(&rays, &options.look(), &machine.run()).map_err(failed)?;
            made.map_err(|e| Failure::bad_file(path, e))
        }
    }
}

impl From<ThicknessWord> for ThicknessRule {
    fn from(word: ThicknessWord) -> Self {
        match word {
            ThicknessWord::Diameter => Self::Diameter,
            ThicknessWord::Radius => Self::Radius,
        }
    }
}

/// Returns the command that helps where a leaf could not be made; empty where none does.
pub(crate) const fn way_out(error: &LeafError) -> &'static str {
    match error {
        LeafError::Several(_) => "; `burgeon bloom run SCAN --plant` makes all of it",
        _ => "",
    }
}

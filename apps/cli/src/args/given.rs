//! Options that were given on the command line: one that a command does not use is an error, never ignored.

use std::collections::BTreeSet;
use std::path::PathBuf;

use burgeon::formats::{ModelFormat, Room};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command, FromArgMatches};

use super::plant_format::PlantFormat;
use super::shared::{CommonArgs, PictureArgs, ViewWord};
use crate::failure::{Failure, Outcome};

/// Options given on the command line, rather than left at their defaults, by the names of their fields.
#[derive(Debug, Default)]
pub(crate) struct Given(BTreeSet<String>);

impl Given {
    /// Whether this option was given.
    pub(crate) fn has(&self, option: &str) -> bool {
        self.0.contains(option)
    }

    /// Fails if one of `options` was given, which `users` use and `this` does not.
    ///
    /// ```text
    /// --lattice is for scans and models; rose is a whole flower: leave it out
    /// ```
    pub(crate) fn refuse(&self, options: &[&str], users: &str, this: &str) -> Outcome {
        match options.iter().find(|o| self.0.contains(**o)) {
            Some(option) => {
                let option = match *option {
                    "inputs" => "DATA".to_owned(),
                    "what" => "a plant".to_owned(),
                    "engine" => "--for".to_owned(),
                    option => format!("--{}", option.replace('_', "-")),
                };
                Err(Failure::Bad(format!("{option} is for {users}; {this}: leave it out")))
            }
            None => Ok(()),
        }
    }

    /// Calls [`refuse`](Self::refuse), unless `used`.
    pub(crate) fn only_if(&self, used: bool, options: &[&str], users: &str, this: &str) -> Outcome {
        if used { Ok(()) } else { self.refuse(options, users, this) }
    }

    /// Calls [`refuse`](Self::refuse), unless the written format `holds` the room that these options need.
    pub(crate) fn only_if_holds(&self, holds: bool, options: &[&str], room: Room) -> Outcome {
        self.only_if(
            holds,
            options,
            &format!("models as {}", ModelFormat::endings_with(room)),
            "none is made",
        )
    }

    /// Refuses the options of pictures where none is made, and those of a turntable where one view is taken.
    pub(crate) fn check_picture(&self, picture: bool, args: &PictureArgs) -> Outcome {
        let all = ["size", "view", "frames", "background", "no_shadow", "supersample"];
        self.only_if(picture, &all, "pictures", "--png FILE.png, which makes one, is missing")?;
        let turntable = matches!(args.view, ViewWord::Turntable);
        self.only_if(turntable, &["frames"], "--view turntable", "the picture has one view")
    }

    /// Refuses the options of axes where no file is read or written whose axes and unit are not fixed by its format.
    pub(crate) fn check_axes(&self, used: bool) -> Outcome {
        let users = "OBJ, PLY, STL, USD, MTG, QSM and other files that do not fix their axes and unit";
        self.only_if(used, &["up", "unit"], users, "none is read or written (glTF is in metres, +Y up)")
    }

    /// Refuses the options of a plant's meshes by the results that use them.
    pub(crate) fn check_surface(&self, seen: Seen) -> Outcome {
        let colours = ["textures", "no_textures", "materials", "petals", "variation"];
        let none = "neither a model nor a picture is made";
        self.only_if(seen.model.is_some() || seen.picture, &colours, "models and pictures", none)?;
        let coloured = seen.picture || seen.model != Some(ModelFormat::Stl);
        self.only_if(coloured, &colours, "models with colours, and pictures", "STL has none")?;
        let counted = seen.model.is_some() || seen.picture || seen.report;
        self.only_if(counted, &["detail", "sides"], "models, pictures and reports", "none is made")?;
        self.only_if_holds(seen.model.is_some_and(|f| f.holds(Room::Wind)), &["wind"], Room::Wind)
    }
}

/// Results in which a plant's meshes appear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// As a model of this format.
    pub(crate) model: Option<ModelFormat>,
    pub(crate) picture: bool,
    /// Counts in a report.
    pub(crate) report: bool,
}

impl Seen {
    pub(crate) fn new(plant: Option<PlantFormat>, png: Option<&PathBuf>, common: &CommonArgs) -> Self {
        let model = match plant {
            Some(PlantFormat::Model(format)) => Some(format),
            Some(PlantFormat::Structure(_) | PlantFormat::Robot(_)) | None => None,
        };
        Self { model, picture: png.is_some(), report: common.reports() }
    }
}

// As a flattened field it sees the matches of the whole command and adds no option.
impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = |id: &&clap::Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        Ok(Self(matches.ids().filter(given).map(ToString::to_string).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl clap::Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

//! `burgeon replay`.

use std::path::PathBuf;

use clap::Args;

use super::given::Given;
use super::shared::{CommonArgs, PictureArgs};

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon replay garden.gestures.json
  burgeon replay garden.gestures.json --save garden.burgeon --png garden.png
  burgeon replay garden.gestures.json --film garden.gif --size 360x360")]
pub(crate) struct ReplayArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// A record that the Studio wrote in a headset (burgeon.gestures/1).
    #[arg(value_name = "RECORD.json")]
    pub(crate) record: PathBuf,
    /// Save the document in which the record ends as a project.
    #[arg(long, value_name = "PROJECT.burgeon")]
    pub(crate) save: Option<PathBuf>,
    /// Make a picture of the plant that was worked on last.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Make an animated picture of the whole record, at its own pace except for long waits; without --size 360x360.
    #[arg(long, value_name = "FILE.gif")]
    pub(crate) film: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

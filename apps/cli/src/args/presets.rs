//! `burgeon presets`.

use std::path::PathBuf;

use clap::Args;

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon presets
  burgeon presets --show oak > mine.toml
  burgeon presets --schema tree.schema.json")]
pub(crate) struct PresetsArgs {
    /// Print the TOML of one preset.
    #[arg(long, value_name = "PRESET")]
    pub(crate) show: Option<String>,
    /// Write the JSON Schema of specs: every field with its meaning, unit (x-unit), range and default.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) schema: Option<PathBuf>,
    /// Print the list as JSON.
    #[arg(long, conflicts_with = "show")]
    pub(crate) json: bool,
}

//! The command line's grammar: the options that every command has, and the commands.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr as _;

use clap::{ArgAction, Parser, Subcommand};
use halfrow_model::ModelPath;
use halfrow_program::choice::one_of;
use halfrow_program::line;

use crate::arguments::given::Given;

/// What the program's own help ends in.
const BEGIN: &str = "\
To begin:
  halfrow verify           Judge the mock board
  halfrow boards --ask     Find your board, then judge it: halfrow verify --board TARGET
  halfrow explain CODE     See what a word of a result means, and what to do";

/// Judges a board that straightens fisheye Bayer video, bit for bit.
///
/// Without a board, `halfrow verify` judges the built-in mock board.
#[derive(Debug, Parser)]
#[command(name = "halfrow", version = halfrow::VERSION, propagate_version = true, max_term_width = 100, after_help = BEGIN)]
pub(super) struct Line<Commands: Subcommand> {
    #[command(flatten)]
    pub(super) given: Given,
    /// Log what happens on the link to stderr; twice for every packet that is late or damaged. With --version: tell
    /// what the program was built from
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub(super) verbose: u8,
    /// Hide progress and how photographs were fitted; results are still printed
    #[arg(short, long, global = true)]
    pub(super) quiet: bool,
    /// The settings file [default: halfrow/settings.toml in the user's configuration folder]
    #[arg(long, global = true, value_name = "FILE", env = "HALFROW_SETTINGS")]
    pub(super) settings: Option<PathBuf>,
    /// How the model computes, always to the same bits: reference, scalar, avx2 or avx512 [default: the fastest here]
    #[arg(long, global = true, value_name = "PATH", env = "HALFROW_MODEL_PATH", hide_possible_values = true)]
    #[arg(value_parser = one_of(ModelPath::ALL.map(ModelPath::name), ModelPath::from_str))]
    pub(super) model_path: Option<ModelPath>,
    /// Print the result, or why there is none, as JSON; `halfrow schema` prints its schema
    #[arg(long, global = true)]
    pub(super) json: bool,
    #[command(subcommand)]
    pub(super) command: Commands,
}

impl Line<Command> {
    /// Reads the program's arguments.
    pub(super) fn read() -> clap::error::Result<Self> {
        let arguments: Vec<OsString> = std::env::args_os().collect();
        // Building the options of all commands would take as long as everything else from start to end.
        if let [_, only] = arguments.as_slice()
            && ["--help", "-h", "help"].iter().any(|help| only == help)
        {
            line::read::<Line<Named>>(arguments.iter().cloned())?;
        }
        line::read(arguments)
    }
}

/// The commands: once with their options, and once by name only, which is all that the program's own help shows.
macro_rules! commands {
    ($($(#[$about:meta])+ $variant:ident($arguments:ty), $name:literal;)+) => {
        #[derive(Debug, Subcommand)]
        pub(super) enum Command {
            $($(#[$about])+ #[command(name = $name)] $variant($arguments),)+
        }

        #[derive(Debug, Subcommand)]
        enum Named {
            $($(#[$about])+ #[command(name = $name)] $variant,)+
        }

        impl Command {
            /// Its name on the command line.
            pub(super) fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $name,)+
                }
            }
        }
    };
}

commands! {
    /// Judge a board: stream frames through it and compare every sample with the reference
    ///
    /// Without --board the built-in mock board is judged. Unless tables, frames, --centre-x or --bits are given, extra frames vary
    /// the optical centre and the depth; a PASS names what no frame exercised. The board's tables are lost: the rules, which come
    /// last, leave it as at power-up. Exit codes: 0 PASS, 1 FAIL, 2 usage, 3 ERROR, 4 busy, 5 nothing judged, 6 identity or version
    /// refused, 129, 130 or 143 interrupted.
    Verify(super::verify::Arguments), "verify";
    /// Judge a board for hours, by frames that it makes at its full pixel clock
    ///
    /// First, some frames are streamed through the board. Then it makes one burst of frames after the other, each with its own
    /// content, and with tables and kernels in turn; it goes on after a difference. If the board goes away, the soak waits for it,
    /// for 300 s unless --reconnect says otherwise. The report says what was judged and when something differed, even if the soak
    /// was interrupted. Exit codes are those of verify; 5 if the board makes no frames.
    Soak(super::soak::Arguments), "soak";
    /// Correct frames with the reference model, or with a board, unjudged
    ///
    /// A board keeps the tables, and their size and depth, until it is given others, loses its power or is judged.
    Correct(super::correct::Arguments), "correct";
    /// Make a table file: a row factor for every row, and a kernel
    Tables(super::tables::Arguments), "tables";
    /// Show a lens's figures and the error that remains after correction
    ///
    /// The error is the distance of each sample from its place in the exact projection, where a vertical line of the scene stays in
    /// one column: the one that it has on the horizon. Row factors correct columns only. The vertical part of the error is given
    /// too, but no table can change it.
    Lens(super::lens::Arguments), "lens";
    /// Fit a kernel to photographs, or measure one on them
    Kernel(super::kernel::Arguments), "kernel";
    /// Reproduce the paper's figures and tables
    ///
    /// Writes one page with pictures and numbers, and each picture and table as a file. Exit codes: 0 every number is accepted, 1
    /// the board differs from the reference, 2 usage, 3 a number is missed or an item could not be made, 5 what was asked for could
    /// not be tried.
    Paper(super::paper::Arguments), "paper";
    /// Write the built-in frames as PGM files
    Frames(super::frames::Arguments), "frames";
    /// List the boards that can be named with --board, and the devices that could be one
    ///
    /// Devices are looked at from outside: whether they are busy, and whether you may open them. With --ask each one that is
    /// free is also greeted, which tells whether a board answers.
    Boards(super::boards::Arguments), "boards";
    /// Say what a board is, what it can do, and what it has counted
    Info(super::info::Arguments), "info";
    /// Test the link to a board: error rate, round trips, throughput each way and together
    ///
    /// Random bytes go to the board and come back; nothing that the board computes is judged. The board's tables are lost. Exit
    /// codes: 0 the link is good enough for `verify`, 1 the board itself spoils what it returns, 3 the link broke or is too poor, 4
    /// busy.
    Link(super::link::Arguments), "link";
    /// Load a bitstream into a board
    ///
    /// Calls openFPGALoader, which must be installed, for the boards that `halfrow boards` lists bitstreams for; another board needs
    /// its own loader. With --board, the loaded board is then greeted, and its build compared with the one in the file next to the
    /// bitstream (top.bit.json of top.bit), which the build scripts write. Exit codes: 0 loaded, and the same build where it was
    /// compared, 2 usage or no loader, nothing was loaded, 3 the loader failed or was killed at its deadline, or nothing answers, 4
    /// busy, 6 the board is of another build.
    Load(super::load::Arguments), "load";
    /// Serve a mock or simulated board to other programs
    ///
    /// The board is put behind a pseudo-terminal or a TCP port. The command prints the target that leads to it, and serves until
    /// Ctrl-C or SIGTERM. It serves one host at a time; others are turned away until that one is gone, or silent for 10 s. If it is
    /// gone without ending its session, the board is held for it for up to 10 s. A board whose wire breaks (fault=disconnect) hangs
    /// up, like a board that is unplugged.
    Serve(super::serve::Arguments), "serve";
    /// Start the production station, a program of its own
    ///
    /// `halfrow station help` lists its commands.
    Station(super::station::Arguments), "station";
    /// List the faults that the mock board can have
    ///
    /// Use one as `--board mock,fault=NAME`, with its parameters after further commas. Faults of the wire also work with `sim`.
    Faults(super::faults::Arguments), "faults";
    /// List the codes of all findings, defects and errors, as JSON has them
    ///
    /// Prints the page docs/CODES.md.
    Codes(super::codes::Arguments), "codes";
    /// Print the page of all commands and their options
    ///
    /// It is docs/COMMANDS.md.
    Commands(super::overview::Arguments), "commands";
    /// Say what a code means, whose fault it is, and what to do first
    ///
    /// It says what to do where that can be known beforehand. Codes are in JSON, in reports, and at the end of errors. For an unknown
    /// code it lists similar ones, with exit code 2.
    Explain(super::explain::Arguments), "explain";
    /// Print the JSON Schema of what --json prints and of report.json
    Schema(super::schema::Arguments), "schema";
    /// Print a completion script for a shell
    ///
    /// For bash: halfrow completions bash > ~/.local/share/bash-completion/completions/halfrow
    Completions(super::completions::Completions), "completions";
    /// Write the manual pages into a folder
    ///
    /// Then: man -l FOLDER/halfrow.1
    Manual(halfrow_program::man_pages::ManualFolder), "manual";
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_help_on_the_whole_program_needs_no_options_of_its_commands() {
        let [mut named, mut whole] = [Line::<Named>::command(), Line::<Command>::command()];
        assert_eq!(named.render_help().to_string(), whole.render_help().to_string());
        assert_eq!(named.render_long_help().to_string(), whole.render_long_help().to_string());
        let unbuilt = Line::<Named>::command();
        assert!(unbuilt.get_subcommands().all(|command| command.get_arguments().next().is_none()));
    }
}

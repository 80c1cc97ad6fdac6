//! `halfrow-station user`

use std::io::{self, BufRead as _, IsTerminal as _};
use std::os::fd::AsRawFd as _;

use clap::{Args, Subcommand};
use nix::sys::termios::{self, LocalFlags, SetArg};

use super::beginning::SettingsFile;
use super::{Failure, print};
use crate::console;
use crate::exit::Exit;
use crate::web::{Role, UserError, Users, add_user};

/// Say who may act on the pages
///
/// The file that `[access]` of the settings names keeps the mark of a badge under the station's key, and the hash of a
/// password. Changes take effect at once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Add somebody: the badge is the first line of stdin, the password of an engineer the second
    Add {
        /// Who, as it stands in records
        name: String,
        /// What they may do
        #[arg(long, value_enum, default_value = "operator")]
        role: Role,
    },
    /// Remove somebody, who is logged out
    Remove {
        /// Who
        name: String,
    },
    /// Print everybody's name and role
    List,
}

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_plant()?;
    let no_file = "the settings name no file of users; write [access] with users = \"users.toml\"";
    let access = settings.access.as_ref().ok_or_else(|| Failure::call(anyhow::anyhow!(no_file)))?;
    match what {
        What::Add { name, role } => {
            std::fs::create_dir_all(&settings.data).map_err(Failure::call)?;
            let badge = asked("badge")?;
            let password = if *role == Role::Engineer { asked("password")? } else { String::new() };
            add_user(&settings, &access.users, (name.trim(), *role), &badge, &password)?;
            print(&format!("{} may act as {}", name.trim(), word(*role)))
        }
        What::Remove { name } => {
            let mut users = Users::load(&access.users).map_err(Failure::call)?;
            users.remove(name)?;
            users.save(&access.users).map_err(Failure::error)?;
            print(&format!("{name} may not act any more"))
        }
        What::List => {
            let users = Users::load_or_none(&access.users).map_err(Failure::call)?;
            let lines: Vec<_> =
                users.names().map(|(name, role)| format!("{:<9} {name}", word(role))).collect();
            print(&lines.join("\n"))
        }
    }
}

fn word(role: Role) -> &'static str {
    match role {
        Role::Operator => "operator",
        Role::Engineer => "engineer",
    }
}

/// Reads a line of stdin. A terminal shows a prompt, and hides what is typed.
fn asked(what: &str) -> Result<String, Failure> {
    let stdin = io::stdin();
    let hidden = if stdin.is_terminal() {
        console::ask(what);
        termios::tcgetattr(stdin.as_raw_fd()).ok()
    } else {
        None
    };
    let show = |is_shown: bool| {
        if let Some(mut settings) = hidden.clone() {
            settings.local_flags.set(LocalFlags::ECHO, is_shown);
            // If a terminal cannot hide it, the line is read all the same.
            let _ = termios::tcsetattr(stdin.as_raw_fd(), SetArg::TCSANOW, &settings);
        }
    };
    show(false);
    let mut line = String::new();
    let read = stdin.lock().read_line(&mut line);
    show(true);
    read.map_err(Failure::call)?;
    Ok(line.trim_end_matches(['\r', '\n']).to_owned())
}

impl From<UserError> for Failure {
    fn from(error: UserError) -> Self {
        Self::call(error)
    }
}

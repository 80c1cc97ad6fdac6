//! `halfrow-station user`

use std::io::{self, BufRead as _, IsTerminal as _, Stdin};
use std::os::fd::AsRawFd as _;

use clap::{Args, Subcommand};
use halfrow::words::plain_lines;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, poll};
use nix::sys::signal::{SigSet, SigmaskHow, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use nix::sys::termios::{self, LocalFlags, SetArg};

use super::beginning::{SettingsFile, make_data};
use super::{Failure, print, tell};
use crate::console;
use crate::exit::Exit;
use crate::web::{Role, Users, add_user};

/// Say who may act on the pages
///
/// The file that `[access]` of the settings names keeps the mark of a badge under the station's key, and the hash of a
/// password. Changes take effect at once.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    settings: SettingsFile,
    #[command(subcommand)]
    what: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
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

/// The settings do not say where it is kept who may act.
#[derive(Debug, thiserror::Error)]
#[error("the settings name no file of users; write [access] with users = \"users.toml\"")]
pub(super) struct NoUsers;

pub(super) fn run(Arguments { settings, what }: &Arguments) -> Result<Exit, Failure> {
    let settings = settings.load_without_lanes()?;
    let access = settings.access.as_ref().ok_or_else(|| Failure::call(NoUsers))?;
    match what {
        Action::Add { name, role } => {
            make_data(&settings)?;
            let badge = asked("badge")?;
            let password = if *role == Role::Engineer { asked("password")? } else { String::new() };
            add_user(&settings, &access.users, (name.trim(), *role), &badge, &password)?;
            Ok(tell(&format!("{} may act as {role}", name.trim())))
        }
        Action::Remove { name } => {
            Users::remove_from(&access.users, name)?;
            Ok(tell(&format!("{name} may not act any more")))
        }
        Action::List => {
            let users = Users::load_or_none(&access.users)?;
            let lines: Vec<_> = users.names().map(|(name, role)| format!("{role:<9} {name}")).collect();
            print(&plain_lines(&lines))
        }
    }
}

/// Reads a line of stdin. A terminal shows a prompt, and hides what is typed.
fn asked(what: &str) -> Result<String, Failure> {
    let stdin = io::stdin();
    let line = if stdin.is_terminal() {
        console::ask(what);
        typed(&stdin)
    } else {
        read(&stdin)
    };
    Ok(line.map_err(Failure::call)?.trim_end_matches(['\r', '\n']).to_owned())
}

fn read(stdin: &Stdin) -> io::Result<String> {
    let mut line = String::new();
    stdin.lock().read_line(&mut line)?;
    Ok(line)
}

/// Reads a line that the terminal hides. A signal that ends the program waits until the terminal shows what is typed
/// again.
fn typed(stdin: &Stdin) -> io::Result<String> {
    let held_up: SigSet = [Signal::SIGINT, Signal::SIGQUIT, Signal::SIGTERM, Signal::SIGHUP, Signal::SIGTSTP]
        .into_iter()
        .collect();
    let signals = SignalFd::with_flags(&held_up, SfdFlags::SFD_CLOEXEC)?;
    loop {
        let before = held_up.thread_swap_mask(SigmaskHow::SIG_BLOCK)?;
        show(stdin, false);
        let is_typed = until_typed(stdin, &signals);
        let line = is_typed.and_then(|is_typed| if is_typed { read(stdin).map(Some) } else { Ok(None) });
        show(stdin, true);
        before.thread_set_mask()?;
        // The signal only stopped the program for a time, or is ignored.
        if let Some(line) = line? {
            return Ok(line);
        }
    }
}

/// Shows or hides what is typed. If a terminal cannot hide it, the line is read all the same.
fn show(stdin: &Stdin, is_shown: bool) {
    if let Ok(mut settings) = termios::tcgetattr(stdin.as_raw_fd()) {
        settings.local_flags.set(LocalFlags::ECHO, is_shown);
        let _ = termios::tcsetattr(stdin.as_raw_fd(), SetArg::TCSANOW, &settings);
    }
}

/// Whether a line was typed before a signal came.
fn until_typed(stdin: &Stdin, signals: &SignalFd) -> io::Result<bool> {
    let mut either = [stdin.as_raw_fd(), signals.as_raw_fd()].map(|fd| PollFd::new(fd, PollFlags::POLLIN));
    while let Err(error) = poll(&mut either, -1) {
        if error != Errno::EINTR {
            return Err(error.into());
        }
    }
    let [_, signalled] = either.map(|fd| fd.revents().is_some_and(|events| !events.is_empty()));
    Ok(!signalled)
}

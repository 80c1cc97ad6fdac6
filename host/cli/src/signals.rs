//! Signals that end a command: Ctrl-C, SIGTERM, and SIGHUP from a terminal or connection that is gone.
//!
//! A command with a board asks for them (`heed`): the first one is noted, so that the command can end in order, and a second
//! ends the program at once, unless it is the first one again (`AGAIN`). Any other command ends at the first. However it ends,
//! nothing half written stays, except for what there is of a recording.

use std::collections::BTreeMap;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use signal_hook::iterator::Signals;

use crate::console;
use crate::exit::Exit;
use halfrow::files::written_aside::{self, Abandoned};
use halfrow::verdict::StoppedBy;
use halfrow_program::signals::ending;

/// How long the last message may take.
const TOLD: Duration = Duration::from_millis(300);

/// How long the same signal counts as the first one: `timeout` sends its own to the program and then to its whole group.
const AGAIN: Duration = Duration::from_millis(500);

/// The exit code of the first signal; 0 before any.
static FIRST: AtomicUsize = AtomicUsize::new(0);
/// When it came.
static FIRST_AT: OnceLock<Instant> = OnceLock::new();
/// Whether the command checks [`FIRST`].
static IS_HEEDED: AtomicBool = AtomicBool::new(false);

/// The program cannot wait for the system's signals.
#[derive(Debug, thiserror::Error)]
#[error(
    "the program cannot wait for signals; end other programs, or allow this user more processes and open files (`ulimit -u`, `ulimit -n`)"
)]
pub struct Unheard(#[from] io::Error);

/// Waits for signals from now on, on a thread of its own.
///
/// # Errors
/// [`Unheard`] when the system takes no handler or has no thread left.
pub fn watch() -> Result<(), Unheard> {
    let ending: BTreeMap<_, _> = ending().collect();
    let mut signals = Signals::new(ending.keys())?;
    thread::Builder::new().name("signals".to_owned()).spawn(move || {
        for signal in &mut signals {
            if let Some(exit) = ending.get(&signal) {
                receive(*exit);
            }
        }
    })?;
    Ok(())
}

/// Who stopped the program, as soon as a signal came. The caller must ask: after this call the first signal no longer ends the
/// program.
pub(crate) fn heed() -> impl Fn() -> Option<StoppedBy> + Copy + Send + Sync + 'static {
    IS_HEEDED.store(true, Ordering::SeqCst);
    || Exit::stopped_by(FIRST.load(Ordering::Relaxed))
}

fn receive(exit: Exit) {
    let code = usize::from(exit.code());
    let since = FIRST_AT.get_or_init(Instant::now);
    let is_first = match FIRST.compare_exchange(0, code, Ordering::SeqCst, Ordering::SeqCst) {
        Ok(_) => true,
        Err(first) => first == code && since.elapsed() < AGAIN,
    };
    if is_first && IS_HEEDED.load(Ordering::SeqCst) {
        return;
    }
    tell(said_of(&written_aside::abandon_all()));
    signal_hook::low_level::exit(exit.code().into());
}

fn said_of(abandoned: &Abandoned) -> String {
    let kept: Vec<_> = abandoned.kept.iter().map(|path| path.display().to_string()).collect();
    match (abandoned.is_any, kept.join(" and ")) {
        (false, _) => "stopped by a signal".to_owned(),
        (true, kept) if kept.is_empty() => "stopped by a signal; what was not whole yet is gone".to_owned(),
        (true, kept) => format!(
            "stopped by a signal; what there is of the recording is kept in {kept}, and what else was not whole yet is gone"
        ),
    }
}

/// Says it on stderr, on a thread with a time limit: the rest of the program may be blocked there for ever.
fn tell(said: String) {
    let (done, is_done) = mpsc::channel();
    let teller = thread::Builder::new().spawn(move || {
        console::error(&said);
        let _ = done.send(());
    });
    if teller.is_ok() {
        let _ = is_done.recv_timeout(TOLD);
    }
}

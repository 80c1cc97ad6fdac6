//! Programs that are told of a saved verdict: lamps, label printers, relays. What they do changes no verdict.

use std::io::{self, Read};
use std::os::unix::process::CommandExt as _;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::floor::Shown;
use crate::group::{KILLED, kill, killed, waited};
use crate::settings::{Hook, WORDS};

/// The most that is kept of what a hook complains of, in bytes.
const MOST_SAID: u64 = 1000;

/// A hook that did not do what it should have done.
#[derive(Debug, thiserror::Error)]
pub enum HookError {
    /// It did not start.
    #[error("the hook {program} cannot be started; check that it is there and may be executed")]
    Start {
        /// The program.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// It failed.
    #[error("the hook {program} failed ({status}): {said}; look at what it drives")]
    Failed {
        /// The program.
        program: String,
        /// How it ended.
        status: ExitStatus,
        /// What it complained of, one line.
        said: String,
    },
    /// It took too long.
    #[error("the hook {program} was killed after {} s; look at what it drives", deadline.as_secs_f64())]
    Late {
        /// The program.
        program: String,
        /// How long it might take.
        deadline: Duration,
    },
}

/// Runs `hook` for the verdict that is shown on `lane`, until it ends or its deadline.
///
/// # Errors
/// [`HookError`] when it did not end well.
pub(super) fn run(hook: &Hook, lane: &str, shown: &Shown) -> Result<(), HookError> {
    let program = || hook.program.display().to_string();
    let mut child = Command::new(&hook.program)
        .args(hook.arguments.iter().map(|argument| filled(argument, lane, shown)))
        .process_group(0)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|source| HookError::Start { program: program(), source })?;
    let complaints = child.stderr.take();
    let (tell, heard) = mpsc::channel();
    let hear = move || tell.send(complaints.map(beginning).unwrap_or_default());
    thread::Builder::new().spawn(hear).map_err(|source| {
        killed(&mut child);
        HookError::Start { program: program(), source }
    })?;
    match waited(&mut child, hook.deadline) {
        None => {
            killed(&mut child);
            Err(HookError::Late { program: program(), deadline: hook.deadline })
        }
        Some(status) if status.success() => Ok(()),
        Some(status) => {
            // What it left behind may hold the pipe open, and may have left its group.
            kill(child.id());
            let said = heard.recv_timeout(KILLED).unwrap_or_default();
            let said = String::from_utf8_lossy(&said).split_whitespace().collect::<Vec<_>>().join(" ");
            Err(HookError::Failed { program: program(), status, said })
        }
    }
}

/// The beginning of what a hook complains of. All of it is read: a hook to which nobody listens dies before its work is done.
fn beginning(mut complaints: impl Read) -> Vec<u8> {
    let mut said = Vec::new();
    let read = complaints.by_ref().take(MOST_SAID).read_to_end(&mut said);
    // What there is no more to be heard of has been said.
    let _ = read.and_then(|_| io::copy(&mut complaints, &mut io::sink()));
    said
}

/// An argument with what its braces stand for.
fn filled(argument: &str, lane: &str, shown: &Shown) -> String {
    let verdict = shown.verdict.to_string();
    let values = [lane, &shown.serial, &verdict, &shown.run, &shown.record_sha256, &shown.headline];
    let mut filled = String::new();
    let mut rest = argument;
    // Once through, so that a value that holds braces stays as it is.
    while let Some((before, value, after)) = first_word(rest, &values) {
        filled = filled + before + value;
        rest = after;
    }
    filled + rest
}

/// What is before the first word between braces, its value, and what is behind.
fn first_word<'a>(text: &'a str, values: &[&'a str; 6]) -> Option<(&'a str, &'a str, &'a str)> {
    let places = WORDS.into_iter().zip(values).filter_map(|(word, value)| {
        let (before, after) = text.split_once(&format!("{{{word}}}"))?;
        Some((before, *value, after))
    });
    places.min_by_key(|(before, ..)| before.len())
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use halfrow::Verdict;

    use super::*;

    fn shown(headline: &str) -> Shown {
        let [run, serial, record_sha256, headline] = ["id", "CA1", "abcd", headline].map(str::to_owned);
        Shown {
            run,
            serial,
            verdict: Verdict::Fail,
            record_sha256,
            headline,
            remedy: None,
            finding: None,
            saved_ms: 0,
        }
    }

    fn hook(script: &str, deadline: u64) -> Hook {
        let arguments = ["-c", script].map(str::to_owned).to_vec();
        Hook { on: Verdict::Fail, program: "sh".into(), arguments, deadline: Duration::from_secs(deadline) }
    }

    #[test]
    fn arguments_say_what_happened_and_a_value_stays_as_it_is() {
        let of = |argument: &str| filled(argument, "3", &shown("a {serial} row"));
        assert_eq!(of("{lane}: {verdict} {serial}"), "3: FAIL CA1");
        assert_eq!(of("{headline}|{run}|{record}"), "a {serial} row|id|abcd");
        assert_eq!(of("plain {"), "plain {");
    }

    #[test]
    fn a_hook_that_fails_says_why() {
        run(&hook("exit 0", 60), "1", &shown("x")).unwrap();
        let failed = run(&hook("echo no paper >&2; exit 3", 60), "1", &shown("x")).unwrap_err();
        assert!(failed.to_string().contains("(exit status: 3): no paper;"), "{failed}");
        let missing = Hook { program: "/no/such/program".into(), ..hook("", 60) };
        assert!(matches!(run(&missing, "1", &shown("x")), Err(HookError::Start { .. })));
    }

    #[test]
    fn a_hook_that_hangs_is_killed_with_all_that_it_started() {
        let folder = tempfile::tempdir().unwrap();
        let id = folder.path().join("id");
        // A busy machine may take longer to start it than it may take in all.
        let begun = [1, 8, 64].into_iter().any(|deadline| {
            let hangs = hook(&format!("sleep 1000 & echo $! > {}; wait", id.display()), deadline);
            assert!(matches!(run(&hangs, "1", &shown("x")), Err(HookError::Late { .. })));
            std::fs::read_to_string(&id).is_ok_and(|id| id.ends_with('\n'))
        });
        assert!(begun);
        let id = std::fs::read_to_string(id).unwrap();
        let is_alive = || {
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", id.trim())).unwrap_or_default();
            !(stat.is_empty() || stat.contains(") Z "))
        };
        let killed = Instant::now();
        while is_alive() {
            assert!(killed.elapsed() < Duration::from_secs(60), "it outlives its hook");
            thread::sleep(Duration::from_millis(10));
        }
    }
}

//! Programs that are told of a saved verdict, or that none is shown any more: lamps, label printers, relays. What they
//! do changes no verdict.

use std::io::{self, Read};
use std::process::Stdio;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::{Duration, Instant};

use crate::floor::Shown;
use crate::process_group::{command, kill, killed, waited};
use crate::settings::{Hook, WORDS};

/// The most that is kept of what a hook writes to stderr, in bytes.
const MOST_SAID: usize = 1000;
/// How long a hook that has ended is still listened to: what it left running may hold its stderr open for ever.
const LISTENED: Duration = Duration::from_secs(5);

/// A hook that did not do what it should have done.
#[derive(Debug, thiserror::Error)]
pub(crate) enum HookError {
    /// The hook could not be started.
    #[error("the hook {program} cannot be started; check that it is there and may be executed")]
    Start {
        /// The program.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// The hook ended with a failure.
    #[error("the hook {program} failed ({status}){}; look at what it drives", of(said))]
    Failed {
        /// The program.
        program: String,
        /// How it ended.
        status: String,
        /// What it wrote to stderr, as one line.
        said: String,
    },
    /// The hook took too long and was killed.
    #[error("the hook {program} was killed after {} s; look at what it drives", deadline.as_secs_f64())]
    Late {
        /// The program.
        program: String,
        /// How long it was allowed to take.
        deadline: Duration,
    },
}

/// What a hook complained of, after a colon; empty if it said nothing.
fn of(said: &str) -> String {
    if said.is_empty() { String::new() } else { format!(": {said}") }
}

/// Runs `hook` for the verdict that is shown on `lane`, if one is, until it ends or its deadline passes.
///
/// # Errors
/// [`HookError`] when it did not end well.
pub(super) fn run(hook: &Hook, lane: &str, shown: Option<&Shown>) -> Result<(), HookError> {
    let program = || hook.program.display().to_string();
    let mut child = command(&hook.program)
        .args(hook.arguments.iter().map(|argument| filled(argument, lane, shown)))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|source| HookError::Start { program: program(), source })?;
    let complaints = child.stderr.take();
    let (tell, told) = mpsc::channel();
    let listen = move || {
        if let Some(complaints) = complaints {
            hear(complaints, tell);
        }
    };
    thread::Builder::new().spawn(listen).map_err(|source| {
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
            kill(child.id());
            let said = heard(&told);
            let said = String::from_utf8_lossy(&said).split_whitespace().collect::<Vec<_>>().join(" ");
            Err(HookError::Failed { program: program(), status: status.to_string(), said })
        }
    }
}

/// Passes on the beginning of what a hook writes to stderr. All of it is read: a hook whose stderr nobody
/// reads dies before its work is done.
fn hear(mut complaints: impl Read, tell: Sender<Vec<u8>>) {
    let (mut piece, mut left) = ([0; MOST_SAID], MOST_SAID);
    while let Ok(read @ 1..) = complaints.read(&mut piece[..left]) {
        left -= read;
        let _ = tell.send(piece[..read].to_vec());
    }
    drop(tell);
    // The rest is read, but not passed on.
    let _ = io::copy(&mut complaints, &mut io::sink());
}

/// What was passed on.
fn heard(told: &Receiver<Vec<u8>>) -> Vec<u8> {
    let (begun, mut said) = (Instant::now(), Vec::new());
    while let Ok(piece) = told.recv_timeout(LISTENED.saturating_sub(begun.elapsed())) {
        said.extend(piece);
    }
    said
}

/// An argument with its placeholders filled in.
fn filled(argument: &str, lane: &str, shown: Option<&Shown>) -> String {
    let Some(shown) = shown else { return argument.replace("{lane}", lane) };
    let verdict = shown.verdict.to_string();
    let values = [lane, &shown.serial, &verdict, &shown.run, &shown.record_sha256, &shown.headline];
    let mut filled = String::new();
    let mut rest = argument;
    // In a single pass, so that braces within a value stay as they are.
    while let Some((before, value, after)) = first_word(rest, &values) {
        filled = filled + before + value;
        rest = after;
    }
    filled + rest
}

/// The text before the first placeholder, the placeholder's value, and the text after it.
fn first_word<'a>(text: &'a str, values: &[&'a str; 6]) -> Option<(&'a str, &'a str, &'a str)> {
    let places = WORDS.into_iter().zip(values).filter_map(|(word, value)| {
        let (before, after) = text.split_once(&format!("{{{word}}}"))?;
        Some((before, *value, after))
    });
    places.min_by_key(|(before, ..)| before.len())
}

#[cfg(test)]
mod tests {
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
            board_kind: None,
            is_identity_checked: true,
        }
    }

    fn hook(script: &str, deadline: u64) -> Hook {
        let arguments = ["-c", script].map(str::to_owned).to_vec();
        Hook {
            on: Some(Verdict::Fail),
            program: "sh".into(),
            arguments,
            deadline: Duration::from_secs(deadline),
        }
    }

    #[test]
    fn arguments_say_what_happened_and_a_value_stays_as_it_is() {
        let of = |argument: &str| filled(argument, "3", Some(&shown("a {serial} row")));
        assert_eq!(of("{lane}: {verdict} {serial}"), "3: FAIL CA1");
        assert_eq!(of("{headline}|{run}|{record}"), "a {serial} row|id|abcd");
        assert_eq!(of("plain {"), "plain {");
        assert_eq!(filled("{lane}: off", "3", None), "3: off");
    }

    #[test]
    fn a_hook_that_fails_says_why() {
        run(&hook("exit 0", 60), "1", Some(&shown("x"))).unwrap();
        let failed = run(&hook("echo no paper >&2; exit 3", 60), "1", Some(&shown("x"))).unwrap_err();
        assert!(failed.to_string().contains("(exit status: 3): no paper;"), "{failed}");
        let silent = run(&hook("exit 3", 60), "1", Some(&shown("x"))).unwrap_err();
        assert!(silent.to_string().ends_with("failed (exit status: 3); look at what it drives"), "{silent}");
        let missing = Hook { program: "/no/such/program".into(), ..hook("", 60) };
        assert!(matches!(run(&missing, "1", Some(&shown("x"))), Err(HookError::Start { .. })));
    }

    /// What it leaves in another session is not killed with it.
    #[test]
    fn a_hook_that_fails_is_over_though_it_leaves_something_behind() {
        let folder = tempfile::tempdir().unwrap();
        let id = folder.path().join("id");
        let id = id.display();
        let leaves = format!(
            "echo no paper >&2; setsid sh -c 'echo $$ > {id}; exec sleep 1000' &
            until test -s {id}; do sleep 0.01; done; exit 4"
        );
        let failed = run(&hook(&leaves, 600), "1", Some(&shown("x"))).unwrap_err();
        let id: u32 = std::fs::read_to_string(id.to_string()).unwrap().trim().parse().unwrap();
        assert!(std::path::Path::new(&format!("/proc/{id}")).exists(), "it is there still");
        kill(id);
        assert!(failed.to_string().contains("(exit status: 4): no paper;"), "{failed}");
    }

    #[test]
    fn a_hook_that_hangs_is_killed_with_all_that_it_started() {
        let folder = tempfile::tempdir().unwrap();
        let id = folder.path().join("id");
        // A busy machine may need longer to start it than the first deadlines allow.
        let begun = [1, 8, 64].into_iter().any(|deadline| {
            let hangs = hook(&format!("sleep 1000 & echo $! > {}; wait", id.display()), deadline);
            assert!(matches!(run(&hangs, "1", Some(&shown("x"))), Err(HookError::Late { .. })));
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

//! Progress of a long run: a bar on a terminal, plain lines elsewhere, or nothing.

use std::fmt::Write;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use halfrow::progress::{Event, Progress, Silent, Soaked};
use halfrow::words::{count, grouped, plain, span};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::console;

/// Progress that suits stderr: a bar on a terminal, a line now and then elsewhere.
#[must_use]
pub(crate) fn for_stderr(quiet: bool) -> Box<dyn Progress> {
    if quiet {
        Box::new(Silent)
    } else if console::is_watched() {
        Box::new(Bar::new())
    } else {
        Box::new(Lines::default())
    }
}

/// Shows what another program prints while it runs: its last line on a terminal, every line elsewhere, or nothing.
pub(crate) enum ChildOutput {
    Nothing,
    Lines,
    Last(ProgressBar),
}

impl ChildOutput {
    /// What suits stderr.
    #[must_use]
    pub(crate) fn on_stderr(quiet: bool) -> Self {
        if quiet {
            Self::Nothing
        } else if console::is_watched() {
            Self::Last(Bar::new().bar)
        } else {
            Self::Lines
        }
    }

    /// The program has printed `line`.
    pub(crate) fn line(&self, line: &str) {
        match self {
            Self::Nothing => {}
            Self::Lines => console::diagnose(&line),
            Self::Last(bar) => {
                say(bar, line);
                bar.tick();
            }
        }
    }

    /// The program has ended.
    pub(crate) fn done(&self) {
        if let Self::Last(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// Shows `words`, which come from elsewhere, beside a bar, with control characters spelt out.
fn say(bar: &ProgressBar, words: &str) {
    bar.set_message(plain(words).into_owned());
}

/// The share of rows, and the time, from which on the time left is estimated. The first rows wait for one-time work.
const TELLING_SHARE: f64 = 0.1;
const TELLING_TIME: Duration = Duration::from_secs(5);

/// The seconds that the rest of the `expected` rows will take, if `rows` of them took `time`; none while it is too early to
/// estimate.
fn seconds_left(rows: u64, expected: u64, time: Duration) -> Option<f64> {
    let share = rows as f64 / expected.max(1) as f64;
    let left = time.as_secs_f64() * (1.0 / share - 1.0).max(0.0);
    (share >= TELLING_SHARE && time >= TELLING_TIME).then_some(left)
}

/// A bar with rate and time left.
struct Bar {
    bar: ProgressBar,
    /// Whether its style is that of a soak. Its length does not tell, since there may be as many rows.
    shows_soak: AtomicBool,
    minutes: Minutes,
}

impl Bar {
    fn new() -> Self {
        // indicatif ignores what the terminal does not take.
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
        bar.set_style(
            ProgressStyle::with_template("{spinner} {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_spinner()),
        );
        Self { bar, shows_soak: AtomicBool::new(false), minutes: Minutes::default() }
    }
}

impl Progress for Bar {
    fn event(&self, event: Event) {
        match event {
            Event::Step(step) => {
                self.bar.set_message(step.to_string());
                self.bar.tick();
            }
            Event::RowsExpected(rows) => self.expect(rows),
            Event::Frame(name) => say(&self.bar, &name),
            Event::AtSpeed(judged) => say(&self.bar, &judged.to_string()),
            Event::Rows(count) => self.bar.inc(count),
            Event::Soaked(soaked) => self.soaked(&soaked),
            Event::Done => self.bar.finish_and_clear(),
        }
    }
}

impl Bar {
    fn expect(&self, rows: u64) {
        self.shows_soak.store(false, Ordering::Relaxed);
        let template = "{bar:30} {pos}/{len} rows  {rate}{left}  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, text: &mut dyn Write| {
                // If this fails, the terminal is gone and nobody needs the number.
                let _ = write!(text, "{:.0} rows/s", state.per_sec());
            };
            let left = |state: &ProgressState, text: &mut dyn Write| {
                let expected = state.len().unwrap_or_default();
                if let Some(seconds) = seconds_left(state.pos(), expected, state.elapsed()) {
                    let _ = write!(text, "  {seconds:.0} s left");
                }
            };
            self.bar.set_style(style.with_key("rate", rate).with_key("left", left));
        }
        self.bar.set_length(self.bar.length().unwrap_or_default() + rows);
    }

    fn soaked(&self, soaked: &Soaked) {
        let (words, minute) = self.minutes.words(soaked);
        if !self.shows_soak.swap(true, Ordering::Relaxed)
            && let Ok(style) = ProgressStyle::with_template("{bar:30} {percent} %  {msg}")
        {
            self.bar.set_style(style);
            self.bar.set_length(SOAK_STEPS);
        }
        self.bar.set_position((soaked.share() * SOAK_STEPS as f64) as u64);
        if minute {
            self.bar.suspend(|| console::diagnose(&words));
        }
        self.bar.set_message(words);
    }
}

/// Steps of a soak's bar.
const SOAK_STEPS: u64 = 1000;

/// The minutes of a soak, each of which is reported once.
#[derive(Default)]
struct Minutes(Mutex<Option<SoakBegun>>);

/// A soak that has begun.
struct SoakBegun {
    /// When it began, by this computer's clock.
    at: Instant,
    /// The last minute that was reported.
    minute: u64,
}

impl Minutes {
    /// How far the soak has come, and whether another minute of it has passed.
    fn words(&self, soaked: &Soaked) -> (String, bool) {
        let mut begun = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let begun = begun.get_or_insert_with(|| SoakBegun { at: Instant::now(), minute: 0 });
        let minute = soaked.time.as_secs() / 60;
        let is_new = minute > begun.minute;
        begun.minute = minute;
        (soak_line(soaked, begun.at.elapsed()), is_new)
    }
}

/// How far a soak has come that has been watched for `time`.
fn soak_line(soaked: &Soaked, time: Duration) -> String {
    let Soaked { frames, wrong, .. } = *soaked;
    let equal = if wrong == 0 { "all equal".to_owned() } else { format!("{} WRONG", grouped(wrong)) };
    let mut words = format!("{}: {}, {equal}", span(soaked.time.as_secs_f64()), count(frames, "frame"));
    let (seconds, share) = (time.as_secs_f64(), soaked.share());
    if seconds > 0.0 {
        let _ = write!(words, ", {:.1} frames/s", frames as f64 / seconds);
    }
    if time >= TELLING_TIME && share > 0.0 {
        let _ = write!(words, ", {} left", span(seconds * (1.0 / share - 1.0)));
    }
    words
}

/// A line every few seconds, for logs.
struct Lines {
    begun: Instant,
    last: Mutex<Instant>,
    rows: AtomicU64,
    expected: AtomicU64,
    minutes: Minutes,
}

impl Default for Lines {
    fn default() -> Self {
        let now = Instant::now();
        Self {
            begun: now,
            last: Mutex::new(now),
            rows: AtomicU64::new(0),
            expected: AtomicU64::new(0),
            minutes: Minutes::default(),
        }
    }
}

impl Lines {
    const EVERY: Duration = Duration::from_secs(5);
}

impl Progress for Lines {
    fn event(&self, event: Event) {
        match event {
            Event::RowsExpected(rows) => {
                self.expected.fetch_add(rows, Ordering::Relaxed);
            }
            Event::Rows(count) => self.count(count),
            Event::Soaked(soaked) => {
                let (words, minute) = self.minutes.words(&soaked);
                if minute {
                    console::diagnose(&words);
                }
            }
            _ => {}
        }
    }
}

impl Lines {
    fn count(&self, count: u64) {
        let rows = self.rows.fetch_add(count, Ordering::Relaxed) + count;
        let Ok(mut last) = self.last.try_lock() else { return };
        if last.elapsed() < Self::EVERY {
            return;
        }
        *last = Instant::now();
        console::diagnose(&line(rows, self.expected.load(Ordering::Relaxed), self.begun.elapsed()));
    }
}

/// The line for a log after `time`.
fn line(rows: u64, expected: u64, time: Duration) -> String {
    let rate = rows as f64 / time.as_secs_f64();
    let left = seconds_left(rows, expected, time).map(|seconds| format!(", {seconds:.0} s left"));
    format!("streaming frames: {rows} of {expected} rows, {rate:.0} rows/s{}", left.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use halfrow::result::SoakLength;

    use super::*;

    #[test]
    fn a_terminal_obeys_no_name_of_a_frame() {
        let bar = Bar::new();
        bar.event(Event::Frame("A\u{1b}]0;title\u{7}.pgm".to_owned()));
        assert_eq!(bar.bar.message(), "A\\u{1b}]0;title\\u{7}.pgm");
    }

    #[test]
    fn the_time_that_is_left_is_told_when_enough_is_done_to_tell_it() {
        let after = |rows, seconds| line(rows, 13_368, Duration::from_secs(seconds));
        assert_eq!(after(512, 9), "streaming frames: 512 of 13368 rows, 57 rows/s");
        assert_eq!(after(6684, 2), "streaming frames: 6684 of 13368 rows, 3342 rows/s");
        assert_eq!(after(6684, 10), "streaming frames: 6684 of 13368 rows, 668 rows/s, 10 s left");
        assert_eq!(line(5, 0, Duration::from_secs(9)), "streaming frames: 5 of 0 rows, 1 rows/s, 0 s left");
    }

    #[test]
    fn every_minute_of_a_soak_is_told_once() {
        let minutes = Minutes::default();
        let told = |seconds| {
            let of = SoakLength::Time { seconds: 28_800.0 };
            let soaked = Soaked { time: Duration::from_secs(seconds), frames: 46 * seconds, wrong: 0, of };
            minutes.words(&soaked).1
        };
        assert_eq!(
            [1, 59, 60, 61, 119, 130, 400, 401].map(told),
            [false, false, true, false, false, true, true, false]
        );
    }

    #[test]
    fn a_soak_tells_what_was_judged_and_how_long_it_still_takes() {
        let of = SoakLength::Time { seconds: 28_800.0 };
        let soaked = |wrong| Soaked { time: Duration::from_secs(4320), frames: 199_872, wrong, of };
        let hour_and_twelve = Duration::from_secs(4320);
        assert_eq!(
            soak_line(&soaked(0), hour_and_twelve),
            "1 h 12 min: 199,872 frames, all equal, 46.3 frames/s, 6 h 48 min left"
        );
        assert!(soak_line(&soaked(2), hour_and_twelve).contains("199,872 frames, 2 WRONG"));
    }
}

//! Progress of a long run, for whoever watches: a bar on a terminal, plain lines otherwise, or nothing.

use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use halfrow::progress::{Event, Progress, Silent};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// What suits the standard error stream: a bar on a terminal, a line now and then elsewhere.
#[must_use]
pub(crate) fn for_stderr(quiet: bool) -> Box<dyn Progress> {
    if quiet {
        Box::new(Silent)
    } else if std::io::stderr().is_terminal() {
        Box::new(Bar::new())
    } else {
        Box::new(Lines::default())
    }
}

/// A bar with rate and time left.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(10));
        bar.set_style(
            ProgressStyle::with_template("{spinner} {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_spinner()),
        );
        Self(bar)
    }
}

impl Progress for Bar {
    fn event(&self, event: Event) {
        match event {
            Event::Step(step) => {
                self.0.set_message(step.to_string());
                self.0.tick();
            }
            Event::RowsExpected(rows) => self.expect(rows),
            Event::Frame(name) => self.0.set_message(name),
            Event::Rows(count) => self.0.inc(count),
            Event::Done => self.0.finish_and_clear(),
        }
    }
}

impl Bar {
    fn expect(&self, rows: u64) {
        let template = "{bar:30} {pos}/{len} rows  {rate}  {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, text: &mut dyn Write| {
                // A watcher whose terminal went away needs no number.
                let _ = write!(text, "{:.0} rows/s", state.per_sec());
            };
            self.0.set_style(style.with_key("rate", rate));
        }
        self.0.set_length(rows);
    }
}

/// A line every few seconds, for logs.
struct Lines {
    begun: Instant,
    last: Mutex<Instant>,
    rows: AtomicU64,
    expected: AtomicU64,
}

impl Default for Lines {
    fn default() -> Self {
        let now = Instant::now();
        Self { begun: now, last: Mutex::new(now), rows: AtomicU64::new(0), expected: AtomicU64::new(0) }
    }
}

impl Lines {
    const EVERY: Duration = Duration::from_secs(5);
}

impl Progress for Lines {
    fn event(&self, event: Event) {
        match event {
            Event::RowsExpected(rows) => self.expected.store(rows, Ordering::Relaxed),
            Event::Rows(count) => self.count(count),
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
        let expected = self.expected.load(Ordering::Relaxed);
        let seconds = self.begun.elapsed().as_secs_f64();
        let rate = rows as f64 / seconds;
        let left = expected.saturating_sub(rows) as f64 / rate;
        eprintln!("{rows} of {expected} rows, {rate:.0} rows/s, {left:.0} s left");
    }
}

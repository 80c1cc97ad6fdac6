//! Progress of a long run, for whoever watches: a bar on a terminal, plain lines otherwise, or nothing.

use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use halfrow::progress::{Progress, Silent};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::console;

/// What suits the standard error stream: a bar on a terminal, a line now and then elsewhere.
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

/// A bar with rate and time left.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, console::bar());
        bar.set_style(
            ProgressStyle::with_template("{spinner} {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_spinner()),
        );
        Self(bar)
    }
}

impl Progress for Bar {
    fn step(&self, what: &str) {
        self.0.set_message(what.to_owned());
        self.0.tick();
    }

    fn rows_expected(&self, rows: u64) {
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

    fn frame(&self, name: &str) {
        self.0.set_message(name.to_owned());
    }

    fn rows(&self, count: u64) {
        self.0.inc(count);
    }

    fn done(&self) {
        self.0.finish_and_clear();
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
    fn rows_expected(&self, rows: u64) {
        self.expected.store(rows, Ordering::Relaxed);
    }

    fn rows(&self, count: u64) {
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
        console::diagnose(&format_args!("{rows} of {expected} rows, {rate:.0} rows/s, {left:.0} s left"));
    }
}

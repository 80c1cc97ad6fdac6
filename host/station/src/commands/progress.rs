//! Progress of what takes long, for whoever watches.

use std::time::{Duration, Instant};

use halfrow::words::{grouped, span};

use crate::console;
use crate::progress::Progress;

/// How often it is printed.
const TELL: Duration = Duration::from_secs(5);

/// Prints from time to time how far something has come, if somebody watches.
pub(super) fn teller() -> impl FnMut(Progress) {
    let begun = Instant::now();
    let (mut what, mut since, mut told) = ("", begun, begun);
    move |progress| {
        if progress.what != what {
            (what, since) = (progress.what, Instant::now());
        }
        if console::is_watched() && told.elapsed() >= TELL {
            told = Instant::now();
            console::diagnose(&text(progress, since.elapsed()));
        }
    }
}

/// A line about what took `time` so far.
fn text(Progress { what, done, of }: Progress, time: Duration) -> String {
    let number = grouped(done);
    let Some(of) = of else { return format!("{number} {what}") };
    let left = time.as_secs_f64() * of.saturating_sub(done) as f64 / done.max(1) as f64;
    format!("{number} of {} {what}, about {} left", grouped(of), span(left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_the_rest_at_the_same_rate() {
        let progress = |done, of| Progress { what: "runs read", done, of };
        assert_eq!(
            text(progress(1500, Some(6000)), Duration::from_secs(60)),
            "1,500 of 6,000 runs read, about 3 min 0 s left"
        );
        assert_eq!(
            text(progress(0, Some(6000)), Duration::from_secs(6)),
            "0 of 6,000 runs read, about 10 h 0 min left"
        );
        assert_eq!(text(progress(7, None), Duration::from_secs(60)), "7 runs read");
    }
}

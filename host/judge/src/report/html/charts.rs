//! Small bar charts next to the map of differences, drawn to its scale.

use std::fmt::Write as _;

use maud::{Markup, html};

/// The length of the longest bar.
const LONGEST: u64 = 100;
/// The length of the shortest bar, so that a single difference is visible next to many.
const SHORTEST: u64 = 3;

/// Differences by row: horizontal bars, one below the other.
pub(super) fn by_row(counts: &[u32], together: usize) -> Markup {
    let (bars, most) = bars(counts, together);
    let path = bars.iter().fold(String::new(), |mut path, (place, length)| {
        let _ = write!(path, "M0 {place}h{length}v1h-{length}z");
        path
    });
    let view = format!("0 0 {LONGEST} {}", counts.len().div_ceil(together));
    chart("rows", &view, &path, &caption(most, together, "row"))
}

/// Differences by column: bars that hang down, side by side.
pub(super) fn by_column(counts: &[u32], together: usize) -> Markup {
    let (bars, most) = bars(counts, together);
    let path = bars.iter().fold(String::new(), |mut path, (place, length)| {
        let _ = write!(path, "M{place} 0v{length}h1v-{length}z");
        path
    });
    let view = format!("0 0 {} {LONGEST}", counts.len().div_ceil(together));
    chart("columns", &view, &path, &caption(most, together, "column"))
}

/// Place and length of the bars that are not empty, with one bar for every `together` counts; and the largest sum.
fn bars(counts: &[u32], together: usize) -> (Vec<(usize, u64)>, u64) {
    let sums: Vec<u64> =
        counts.chunks(together).map(|chunk| chunk.iter().copied().map(u64::from).sum()).collect();
    let most = sums.iter().copied().max().unwrap_or(0);
    let length = |sum: u64| (sum * LONGEST / most.max(1)).max(SHORTEST);
    let some = sums.iter().enumerate().filter(|(_, sum)| **sum > 0);
    (some.map(|(place, &sum)| (place, length(sum))).collect(), most)
}

fn caption(most: u64, together: usize, what: &str) -> String {
    match together {
        1 => format!("Differences in each {what}: at most {most}"),
        _ => format!("Differences in each {together} {what}s: at most {most}"),
    }
}

fn chart(class: &str, view: &str, path: &str, caption: &str) -> Markup {
    html! {
        div.chart.(class) {
            svg viewBox=(view) preserveAspectRatio="none" role="img" aria-label=(caption) {
                title { (caption) }
                path d=(path) {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_long_as_their_sums_and_never_too_short_to_see() {
        let (bars, most) = bars(&[0, 0, 1, 1, 0, 0, 200, 0, 50], 2);
        assert_eq!(most, 200);
        assert_eq!(bars, [(1, 3), (3, 100), (4, 25)]);
    }
}

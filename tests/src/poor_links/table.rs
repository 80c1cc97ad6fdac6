//! The table that a campaign prints.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use halfrow::verdict::Verdict;

use super::{Came, PoorLinks, Run};

impl PoorLinks {
    fn count(&self, of: impl Fn(&Run) -> bool, came: Came) -> usize {
        self.0.iter().filter(|run| of(run) && run.came == came).count()
    }

    /// How many runs ended in each error, by kind of link and board, with the numbers in its sentence left out.
    fn reasons(&self) -> BTreeMap<(&str, &str, String), usize> {
        let mut reasons = BTreeMap::new();
        for run in self.0.iter().filter(|run| run.came == Came::To(Verdict::Error)) {
            let board = if run.is_broken() { "broken" } else { "sound" };
            let sentence = run.headline.split(';').next().unwrap_or_default();
            let sentence = sentence
                .replace(|letter: char| letter.is_ascii_digit(), "#")
                .replace("##", "#")
                .replace("##", "#");
            *reasons.entry((run.case.kind, board, sentence)).or_default() += 1;
        }
        reasons
    }

    fn line(&self, f: &mut fmt::Formatter<'_>, name: &str, of: impl Fn(&Run) -> bool + Copy) -> fmt::Result {
        let [pass, fail, error] =
            [Verdict::Pass, Verdict::Fail, Verdict::Error].map(|verdict| self.count(of, Came::To(verdict)));
        let hangs = self.count(of, Came::Nowhere);
        let share = 100.0 * error as f64 / (pass + fail + error + hangs).max(1) as f64;
        writeln!(f, "{name:<28}{pass:>8}{fail:>8}{error:>8} ({share:5.1} %){hangs:>8}")
    }

    fn bound(
        &self,
        f: &mut fmt::Formatter<'_>,
        what: &str,
        of: impl Fn(&Run) -> bool,
        is: impl Fn(&Run) -> bool,
    ) -> fmt::Result {
        let (mut all, mut found) = (0, 0);
        for run in self.0.iter().filter(|run| of(run)) {
            all += 1;
            found += usize::from(is(run));
        }
        // With none in N, the rate is below 3/N at 95 % confidence.
        let bound = 3.0 / all.max(1) as f64;
        writeln!(f, "{what}: {found} of {all}; with none, the rate is below {bound:.1e} at 95 % confidence")
    }
}

impl fmt::Display for PoorLinks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<28}{:>8}{:>8}{:>8}{:>10}{:>8}",
            "link and board", "PASS", "FAIL", "ERROR", "", "hang"
        )?;
        let kinds: BTreeSet<_> = self.0.iter().map(|run| run.case.kind).collect();
        for kind in kinds {
            for (broken, board) in [(false, "sound"), (true, "broken")] {
                let of = |run: &Run| run.case.kind == kind && run.is_broken() == broken;
                self.line(f, &format!("{kind}, {board}"), of)?;
            }
        }
        for (broken, board) in [(false, "all, sound"), (true, "all, broken")] {
            self.line(f, board, |run| run.is_broken() == broken)?;
        }
        self.bound(f, "false PASS", Run::is_broken, Run::is_false)?;
        self.bound(f, "false FAIL", |run| !run.is_broken(), Run::is_false)?;
        self.bound(f, "hang", |_| true, |run| run.came == Came::Nowhere)?;
        writeln!(f, "errors, by what they say:")?;
        for ((kind, board, sentence), count) in self.reasons() {
            writeln!(f, "{count:>6}  {kind}, {board}: {sentence}")?;
        }
        for run in self.false_verdicts().chain(self.hangs()).chain(self.needless_errors()) {
            writeln!(f, "{:?}: {:?}: {}", run.case, run.came, run.headline)?;
        }
        Ok(())
    }
}

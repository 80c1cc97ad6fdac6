//! Poor links by the thousand: none makes a sound board fail, and none lets a broken one pass.

use std::fmt;

use halfrow::verdict::Verdict;

use crate::dice::Dice;
use crate::parallel;
use crate::system::System;

/// A board that computes every frame wrongly.
const BROKEN: &str = ",fault=no-rounding";

/// A run over a link that was drawn.
#[derive(Clone, Debug)]
pub struct Run {
    /// The link's fault, as options of a target.
    pub link: String,
    /// Whether the board behind it is broken.
    pub broken: bool,
    /// What the run came to.
    pub verdict: Verdict,
    /// The result in one sentence.
    pub headline: String,
}

/// All runs of a campaign.
#[derive(Clone, Debug)]
pub struct PoorLinks(pub Vec<Run>);

/// Judges `count` boards over links that are drawn by `seed`; every second board is broken.
#[must_use]
pub fn run(count: usize, seed: u64) -> PoorLinks {
    let mut dice = Dice::new(seed);
    let links: Vec<_> = (0..count).map(|index| (draw(&mut dice), index % 2 == 1)).collect();
    PoorLinks(parallel::map(&links, |(link, broken)| {
        let options = if *broken { format!("{link}{BROKEN}") } else { link.clone() };
        let report = System::TINY.judge(&options);
        Run { link: link.clone(), broken: *broken, verdict: report.verdict, headline: report.headline() }
    }))
}

/// A fault of the wire at a rate of 10^-6 to 10^-2.
fn draw(dice: &mut Dice) -> String {
    let name = dice.one_of(&["flip", "drop", "duplicate", "reorder", "truncate", "stall", "disconnect"]);
    let toward = dice.one_of(&["board", "host", "both"]);
    let (rate, seed) = (dice.magnitude(-6.0, -2.0), dice.below(1 << 31));
    let seconds = match name {
        "stall" => format!(",seconds={}", dice.magnitude(-3.0, 1.0)),
        _ => String::new(),
    };
    format!(",fault={name},rate={rate:e},toward={toward},seed={seed}{seconds}")
}

impl Run {
    /// Whether the verdict is not the board's: PASS of a broken one, or FAIL of a sound one.
    #[must_use]
    pub fn is_false(&self) -> bool {
        self.verdict == if self.broken { Verdict::Pass } else { Verdict::Fail }
    }
}

impl PoorLinks {
    /// The runs whose verdict is not the board's.
    pub fn false_verdicts(&self) -> impl Iterator<Item = &Run> {
        self.0.iter().filter(|run| run.is_false())
    }

    fn count(&self, broken: bool, verdict: Verdict) -> usize {
        self.0.iter().filter(|run| (run.broken, run.verdict) == (broken, verdict)).count()
    }
}

impl fmt::Display for PoorLinks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<14}{:>8}{:>8}{:>8}", "board", "PASS", "FAIL", "ERROR")?;
        for (broken, name) in [(false, "sound"), (true, "broken")] {
            let [pass, fail, error] =
                [Verdict::Pass, Verdict::Fail, Verdict::Error].map(|verdict| self.count(broken, verdict));
            writeln!(f, "{name:<14}{pass:>8}{fail:>8}{error:>8}")?;
        }
        for (broken, verdict, name) in
            [(true, Verdict::Pass, "false PASS"), (false, Verdict::Fail, "false FAIL")]
        {
            let wrong = self.count(broken, verdict);
            let judged = self.0.iter().filter(|run| run.broken == broken).count();
            // With none in N, the rate is below 3/N at 95 % confidence.
            let bound = 3.0 / judged.max(1) as f64;
            writeln!(
                f,
                "{name}: {wrong} of {judged}; with none, the rate is below {bound:.1e} at 95 % confidence"
            )?;
        }
        for run in self.false_verdicts() {
            writeln!(
                f,
                "{} of a {} board over {}: {}",
                run.verdict,
                if run.broken { "broken" } else { "sound" },
                run.link,
                run.headline
            )?;
        }
        Ok(())
    }
}

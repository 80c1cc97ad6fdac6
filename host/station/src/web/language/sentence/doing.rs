//! What a run does, in the words of a language.

use halfrow::progress::Step;

use super::{Sentence, Words};
use crate::record::StepOutcome;

impl Words {
    /// What a run does, as its lane reports it. The names that a plan gives to steps and frames stay as they are.
    pub(in crate::web) fn doing(&self, what: &str) -> Sentence {
        match self.step(what).or_else(|| self.ended(what)).or_else(|| self.board(what)) {
            Some(text) => Sentence { text, foreign: None },
            None => self.english(what.to_owned()),
        }
    }

    /// The judge's step of this name, with how far it is.
    fn step(&self, what: &str) -> Option<String> {
        let known = [
            (Step::JudgeTheJudge, self.say("step.judge")),
            (Step::OpenTheBoard, self.say("step.open")),
            (Step::TestTheLink, self.say("step.link")),
            (Step::AtSpeed, self.say("step.speed")),
            (Step::Rules, self.say("step.rules")),
            (Step::LookAgain, self.say("step.again")),
            (Step::WaitForTheBoard, self.say("step.wait")),
        ];
        known.into_iter().find_map(|(step, words)| match what.strip_prefix(&*step.to_string())? {
            "" => Some(words.to_owned()),
            so_far => {
                let (some, all) = so_far.strip_prefix(", ")?.split_once(" of ")?;
                let so_far = self.fill("told.some", &[("some", some), ("all", all)]);
                Some(format!("{words}{}{so_far}", self.say("told.colon")))
            }
        })
    }

    /// How a step of the plan ended.
    fn ended(&self, what: &str) -> Option<String> {
        let (step, outcome) = what.rsplit_once(' ')?;
        let words = match outcome.parse().ok()? {
            StepOutcome::Passed => self.say("run.passed"),
            StepOutcome::Failed => self.say("run.failed"),
            StepOutcome::Error => self.say("run.error"),
            StepOutcome::Skipped => self.say("run.skipped"),
        };
        Some(format!("{step}{}{words}", self.say("told.colon")))
    }

    /// Which board it is.
    fn board(&self, what: &str) -> Option<String> {
        Some(self.fill("step.board", &[("name", what.strip_prefix("the board is ")?)]))
    }
}

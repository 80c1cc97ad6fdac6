//! What a run does, in the words of a language.

use halfrow::progress::Step;

use super::{Sentence, Words};
use crate::lane::Doing;
use crate::record::StepOutcome;

impl Words {
    /// What a run does. The names that a plan gives to steps and frames stay as they are.
    pub(in crate::web) fn doing(&self, doing: &Doing) -> Sentence {
        let colon = self.say("told.colon");
        let text = match doing {
            Doing::Named(name) => return self.english(name.clone()),
            Doing::Judging(step) => self.step(*step).to_owned(),
            Doing::AtSpeed(judged) => {
                let [some, all] = [judged.frames, judged.of].map(|frames| frames.to_string());
                let so_far = self.fill("told.some", &[("some", &some), ("all", &all)]);
                format!("{}{colon}{so_far}", self.step(Step::AtSpeed))
            }
            Doing::Rows(..) => self.say("lane.rows").to_owned(),
            Doing::Ended { step, outcome } => format!("{step}{colon}{}", self.outcome(*outcome)),
            Doing::Board(name) => self.fill("step.board", &[("name", name)]),
            Doing::Place(name) => self.fill("step.place", &[("name", name)]),
        };
        Sentence { text, foreign: None }
    }

    /// A step of the judge.
    fn step(&self, step: Step) -> &str {
        match step {
            Step::JudgeTheJudge => self.say("step.judge"),
            Step::OpenTheBoard => self.say("step.open"),
            Step::TestTheLink => self.say("step.link"),
            Step::AtSpeed => self.say("step.speed"),
            Step::Rules => self.say("step.rules"),
            Step::LookAgain => self.say("step.again"),
            Step::WaitForTheBoard => self.say("step.wait"),
        }
    }

    /// How a step of the plan ended.
    fn outcome(&self, outcome: StepOutcome) -> &str {
        match outcome {
            StepOutcome::Passed => self.say("run.passed"),
            StepOutcome::Failed => self.say("run.failed"),
            StepOutcome::Error => self.say("run.error"),
            StepOutcome::Skipped => self.say("run.skipped"),
        }
    }
}

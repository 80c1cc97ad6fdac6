//! An error as data: its code, its parameters, and its causes.

use std::error::Error;
use std::{fmt, io, iter};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::codes::{self, Coded};
use super::{Defect, Finding, wording};
use crate::run::Lack;
use crate::words::sentence;

/// Parameters, by name.
pub type Parameters = Map<String, Value>;

/// Why something could not be done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Problem {
    /// The code: stable, for programs.
    pub code: String,
    /// The figures and names in its message.
    pub parameters: Parameters,
    /// It in one sentence.
    pub message: String,
    /// What to do about it, if known.
    pub remedy: Option<String>,
    /// What led to it, the nearest cause first; causes have none of their own.
    #[serde(default)]
    pub causes: Vec<Problem>,
}

impl Problem {
    /// A problem without parameters and causes.
    #[must_use]
    pub fn new(code: &str, message: impl Into<String>) -> Self {
        Self::with(code, Parameters::new(), message.into())
    }

    fn with(code: &str, parameters: Parameters, message: String) -> Self {
        let remedy = split_remedy(&message, &parameters).and_then(|(_, remedy)| sentence(remedy));
        Self { code: code.to_owned(), parameters, message, remedy, causes: Vec::new() }
    }

    /// The problem that an error of this library stands for, with its causes.
    #[must_use]
    pub fn of(error: &(dyn Error + 'static)) -> Self {
        Self::by(error, codes::lookup)
    }

    /// The problem that an error stands for, with its causes and the codes that `lookup` finds. An error without a code that
    /// wraps one with a code takes that code; any other without a code gets [`codes::FOREIGN`].
    #[must_use]
    pub fn by(error: &(dyn Error + 'static), lookup: codes::Lookup) -> Self {
        let mut chain: Vec<_> = iter::successors(Some(error), |&error| error.source())
            .flat_map(|error| told(error).map_or_else(|| vec![one(error, lookup)], Problem::chain))
            .collect();
        if let Some(known) = chain.iter().find(|problem| problem.code != codes::FOREIGN).cloned()
            && let Some(first) = chain.first_mut().filter(|first| first.code == codes::FOREIGN)
        {
            (first.code, first.parameters) = (known.code, known.parameters);
        }
        let remedy = chain.iter().find_map(|problem| problem.remedy.clone());
        let mut chain = chain.into_iter();
        let first = chain.next().unwrap_or_else(|| Self::new(codes::FOREIGN, ""));
        Self { remedy, causes: chain.collect(), ..first }
    }

    /// This problem of a call that is refused because of `error`. If the system alone is the cause, it asks for what lets the same
    /// call succeed, and not for another name or other rights.
    #[must_use]
    pub fn of_refusal(self, error: &(dyn Error + 'static)) -> Self {
        let Some(asked) = asked_of_system(error) else { return self };
        let mut unasked = self.unasked();
        unasked.causes.iter_mut().for_each(|cause| cause.remedy = None);
        Self { message: format!("{}; {asked}", unasked.message), remedy: sentence(asked), ..unasked }
    }

    /// The problem without what to do about it.
    #[must_use]
    pub(crate) fn unasked(mut self) -> Self {
        let causes = self.causes.iter_mut().map(|cause| (&mut cause.message, &cause.parameters));
        for (message, parameters) in iter::once((&mut self.message, &self.parameters)).chain(causes) {
            if let Some((what, _)) = split_remedy(message, parameters) {
                *message = what.to_owned();
            }
        }
        self.remedy = None;
        self
    }

    /// The problem and its causes, none of which has causes of its own.
    #[must_use]
    pub fn chain(mut self) -> Vec<Self> {
        let causes = std::mem::take(&mut self.causes);
        iter::once(self).chain(causes).collect()
    }

    /// The problem and its causes in one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let causes = self.causes.iter().map(|cause| cause.message.as_str());
        iter::once(self.message.as_str()).chain(causes).collect::<Vec<_>>().join(": ")
    }
}

/// What lets the call succeed that is refused because of `error`, if the system alone is the cause.
pub(crate) fn asked_of_system(error: &(dyn Error + 'static)) -> Option<&'static str> {
    let mut causes = iter::successors(Some(error), |&error| error.source());
    causes.find_map(|cause| halfrow_files::asked_of_system(cause.downcast_ref::<io::Error>()?))
}

/// The problem that an error is, or has in it.
fn told(error: &(dyn Error + 'static)) -> Option<Problem> {
    let lack = || error.downcast_ref().map(|Lack { what, .. }| &**what);
    error.downcast_ref().or_else(lack).cloned()
}

fn one(error: &(dyn Error + 'static), lookup: codes::Lookup) -> Problem {
    let Coded { code, parameters } = lookup(error).unwrap_or_else(Coded::foreign);
    Problem::with(&code, parameters, error.to_string())
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence())
    }
}

impl Error for Problem {}

/// What stands before a remedy: in English, and in the languages that sentences are translated into.
const SEMICOLONS: [&str; 2] = ["; ", "；"];

/// Splits a message into what is wrong and what to do. The latter follows the last semicolon that is not part of a name in
/// `parameters`.
#[must_use]
pub fn split_remedy<'a>(message: &'a str, parameters: &Parameters) -> Option<(&'a str, &'a str)> {
    let has_mark = |name: &&str| SEMICOLONS.iter().any(|mark| name.contains(mark));
    let names = parameters.values().filter_map(Value::as_str).filter(has_mark);
    let masked = names.fold(message.to_owned(), |text, name| text.replace(name, &"_".repeat(name.len())));
    let marks = SEMICOLONS.iter().filter_map(|mark| Some((masked.rfind(mark)?, mark.len())));
    let (at, length) = marks.max()?;
    Some((message.get(..at)?, message.get(at + length..)?))
}

impl Finding {
    /// The finding in one sentence, without a full stop.
    #[must_use]
    pub fn sentence(&self) -> String {
        wording::sentence(self)
    }

    /// What to do about it, if anything.
    #[must_use]
    pub fn remedy(&self) -> Option<String> {
        wording::remedy(self)
    }

    /// What a technician should do with the board; none for findings that are not against the board.
    #[must_use]
    pub fn technician(&self) -> Option<String> {
        wording::at_the_bench(self)
    }

    /// The finding's code.
    #[must_use]
    pub fn code(&self) -> String {
        tagged(self).0
    }

    /// The finding as a problem: the reason why there is no result.
    #[must_use]
    pub fn as_problem(&self) -> Problem {
        if let Self::Problem(problem) = self {
            return (**problem).clone();
        }
        let (code, parameters) = tagged(self);
        let (message, remedy) = (self.sentence(), self.remedy());
        Problem { code, parameters, message, remedy, causes: Vec::new() }
    }
}

impl From<Problem> for Finding {
    fn from(problem: Problem) -> Self {
        Self::Problem(Box::new(problem))
    }
}

/// The code and the parameters of a finding or a defect.
pub(super) fn tagged(value: &impl Serialize) -> (String, Parameters) {
    let value = serde_json::to_value(value).unwrap_or_default();
    let code = value.get("code").and_then(Value::as_str).unwrap_or_default().to_owned();
    debug_assert!(!code.is_empty(), "every finding and every defect has a code");
    let parameters = value.get("parameters").and_then(Value::as_object).cloned().unwrap_or_default();
    (code, parameters)
}

impl Defect {
    /// Its code and its parameters.
    #[must_use]
    pub fn tagged(&self) -> (String, Parameters) {
        tagged(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::BoardError;

    #[test]
    fn no_part_of_a_name_is_what_to_do() {
        let name = "w; rm -rf y.json";
        let parameters = Parameters::from_iter([("path".to_owned(), name.into())]);
        let about = |rest: &str| Problem::with("code", parameters.clone(), format!("{name} {rest}"));
        assert_eq!(about("cannot be used").remedy, None);
        let problem = about("cannot be used; give another one");
        assert_eq!(problem.remedy.as_deref(), Some("Give another one."));
        assert_eq!(problem.unasked().message, "w; rm -rf y.json cannot be used");
    }

    #[test]
    fn what_to_do_is_a_whole_sentence() {
        let held = Problem::of(&BoardError::Held { seconds: 0.5 });
        let asked =
            "Wait until it is done (silent for 10 s, of which 0.5 s are left), or take the board over.";
        assert_eq!(held.remedy.as_deref(), Some(asked));
    }

    #[test]
    fn all_that_a_poor_link_asks_for_is_in_its_remedy() {
        let problem = Problem::of(&BoardError::TooPoor { retries: 9, packets: 99, limit: 5 });
        let remedy = problem.remedy.clone().unwrap();
        assert!(remedy.starts_with("Check cable, connectors and rate"), "{remedy}");
        assert!(remedy.contains("`halfrow link`"), "{remedy}");
        let left = problem.unasked().message;
        assert!(left.ends_with("5 are allowed"), "{left}");
    }
}

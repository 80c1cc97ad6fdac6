//! What people are told: in English, and as a code with parameters from which pages say it in other languages.

use std::error::Error;
use std::{fmt, iter};

use halfrow::result::codes::{FOREIGN, Parameter};
use halfrow::result::{Finding, Parameters, Problem};
use halfrow::words::{count, verb};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Value, json};

use crate::codes::known;

/// A sentence for people. It is displayed as its English text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Said {
    /// Its code, as docs/CODES.md and docs/STATION-CODES.md list them.
    pub code: String,
    /// Its figures and names.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub parameters: Parameters,
    /// The sentence in English.
    pub message: String,
    /// Its causes, the nearest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub causes: Vec<Self>,
}

/// The parameter, of the reason why a run broke off, that counts the samples which differed by then.
pub(crate) const DIFFERED: &str = "differed";

/// The codes of errors of the link that a board which was unplugged may leave behind, whatever leads to it.
const ABSENT: [&str; 10] = [
    "board-unplugged",
    "connection-closed",
    "link-closed",
    "link-failed",
    "link-without-board",
    "serial-port-missing",
    "tcp-refused",
    "usb-board-missing",
    "usb-no-board",
    "usb-other-devices-only",
];

/// What to do, in full sentences and by code, about what the station says in a sentence that does not end in it.
pub(crate) const REMEDIES: [(&str, &str); 10] = [
    ("plan-takes-hardware", "Check the lane's target."),
    ("build-not-of-plan", "Load a released build, or take the plan for this one."),
    ("device-asked-for", "Load a build that reads the FPGA's own number."),
    ("board-swapped", "Leave the board in its place, and test it again."),
    ("device-in-other-lane", "Wait until that run is over."),
    ("board-of-other-product", MIXED_UP),
    ("board-of-other-serial", MIXED_UP),
    ("serial-of-other-device", MIXED_UP),
    (
        "measurement-beyond-limit",
        "Have an engineer look at this lane, or at the limit in the plan, and test the board again.",
    ),
    (
        "measurement-missing",
        "Have an engineer look at the limit in the plan: this board or lane has no such value.",
    ),
];
const MIXED_UP: &str =
    "Scan the label of the board that is in the lane; after a repair, an engineer binds it again.";

impl Said {
    /// What the judge's report says with a code and parameters, in the words of `message`.
    pub(crate) fn reported(of: &Value, message: &str) -> Option<Self> {
        let code = of.get("code")?.as_str()?.to_owned();
        let parameters = of.get("parameters").and_then(Value::as_object).cloned().unwrap_or_default();
        Some(Self { code, parameters, message: message.to_owned(), causes: Vec::new() })
    }

    /// What to do about it, where the sentence does not end in that.
    pub(crate) fn remedy(&self) -> Option<&'static str> {
        REMEDIES.into_iter().find(|(code, _)| *code == self.code).map(|(_, remedy)| remedy)
    }

    /// Whether it, or a cause of it, is that the board no longer knew the session.
    pub(crate) fn is_of_lost_session(&self) -> bool {
        self.code == "session-lost" || self.causes.iter().any(Self::is_of_lost_session)
    }

    /// Whether it, or a cause of it, is that the connection to the board ended, or that nothing is where the board was.
    pub(crate) fn is_of_absent_board(&self) -> bool {
        ABSENT.contains(&self.code.as_str()) || self.causes.iter().any(Self::is_of_absent_board)
    }

    /// What the judge says, for people who cannot do what is done at a bench: nobody takes a board over from a lane.
    pub(crate) fn at_the_station(self) -> Self {
        match self.parameters.get("seconds").and_then(Value::as_f64) {
            Some(seconds) if self.code == "board-held" => {
                Saying::StillHeld { seconds: seconds.ceil() }.into()
            }
            _ => self,
        }
    }

    /// What to do about a board that an earlier session still holds.
    pub(crate) fn scan_again(&self) -> Option<String> {
        let seconds = self.parameters.get("seconds").and_then(Value::as_f64)?;
        (self.code == "board-still-held").then(|| format!("Scan the label again in {seconds:.0} s."))
    }

    /// A sentence in English that has no code.
    pub(crate) fn uncoded(message: String) -> Self {
        Self { code: String::new(), parameters: Parameters::new(), message, causes: Vec::new() }
    }

    /// The sentence with its causes, and the codes of both behind it, as a log has it: who reads a log looks a code up, and a program
    /// that watches one finds no sentence that stays.
    pub(crate) fn with_codes(&self) -> String {
        let all = iter::once(self).chain(&self.causes).map(|said| said.code.as_str());
        let mut codes: Vec<_> = all.filter(|code| !["", FOREIGN].contains(code)).collect();
        codes.dedup();
        if codes.is_empty() { self.to_string() } else { format!("{self} ({})", codes.join(", ")) }
    }

    /// An error of this program with its causes.
    #[must_use]
    pub fn of(error: &(dyn Error + 'static)) -> Self {
        Problem::by(error, known).into()
    }
}

impl From<Problem> for Said {
    fn from(problem: Problem) -> Self {
        let Problem { code, parameters, message, causes, .. } = problem;
        Self { code, parameters, message, causes: causes.into_iter().map(Self::from).collect() }
    }
}

impl From<Saying> for Said {
    fn from(saying: Saying) -> Self {
        Self::of(&saying)
    }
}

/// What the judge found.
impl From<&Finding> for Said {
    fn from(finding: &Finding) -> Self {
        match finding {
            Finding::Problem(problem) => Problem::clone(problem).into(),
            finding => {
                let Problem { code, parameters, message, .. } = finding.as_problem();
                Self { code, parameters, message, causes: Vec::new() }
            }
        }
    }
}

/// The sentence, followed by its causes.
impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        self.causes.iter().try_for_each(|cause| write!(f, ": {}", cause.message))
    }
}

impl Parameter for Said {
    fn parameter(&self) -> Value {
        json!({ "code": self.code, "parameters": self.parameters, "message": self.to_string() })
    }
}

/// Serializes it as its text.
pub(crate) fn as_text<S: Serializer>(said: &Said, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(said)
}

/// Like [`as_text`], if there is one.
pub(crate) fn as_text_if_any<S: Serializer>(said: &Option<Said>, to: S) -> Result<S::Ok, S::Error> {
    said.as_ref().map(ToString::to_string).serialize(to)
}

/// What the station says that is not an error with a type of its own: answers to scans, why a lane is out of service, results
/// of steps. Its codes are in `codes`.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence says what each is, and what its figures are")]
pub enum Saying {
    #[error("the next scan is for lane {lane}")]
    Armed { lane: String },
    #[error("lane {lane} starts")]
    Starts { lane: String },
    #[error("ending the run in lane {lane}")]
    ToldToEnd { lane: String },
    #[error("lane {lane} has forgotten {serial}; scan its label again")]
    Forgotten { lane: String, serial: String },
    #[error("lane {lane} is out of service")]
    TakenOut { lane: String },
    #[error("lane {lane} is in service")]
    PutBack { lane: String },
    #[error("{serial} is tested in lane {lane}")]
    Tested { serial: String, lane: String },
    #[error("the mock board with a random fault is judged in lane {lane}")]
    MockJudged { lane: String },
    #[error("{serial} waits in lane {lane}")]
    Waits { serial: String, lane: String },
    #[error("{serial} waits for the next board that is plugged in")]
    WaitsForPlug { serial: String },
    #[error("{serial} waits for the next board that is plugged in, instead of {other}")]
    WaitsInstead { serial: String, other: String },
    #[error("{serial} waited for this board, and is not tested: {why}; then scan it again")]
    NotGiven { serial: String, why: Said },
    #[error("taken out by hand")]
    OutByPerson,
    #[error("its process cannot be killed; restart the computer")]
    Unkillable,
    #[error("the good unit {serial} was judged {verdict}; have an engineer look at the lane")]
    GoodUnitWrong { serial: String, verdict: String },
    #[error("the bad unit {serial} was judged {verdict}; have an engineer look at the lane")]
    BadUnitWrong { serial: String, verdict: String },
    #[error("to check this shift, the good unit {serial} must be judged PASS first; scan its label")]
    GoodUnitDue { serial: String },
    #[error("to check this shift, the bad unit {serial} must be judged FAIL first; scan its label")]
    BadUnitDue { serial: String },
    #[error(
        "to check this shift, the mock board with a random fault must be judged FAIL first; scan {barcode}"
    )]
    MockDue { barcode: String },
    #[error(
        "{target} was judged {verdict}, so the plan does not find this fault; have an engineer look at the plan, \
         and scan {barcode} for another fault"
    )]
    MockWrong { target: String, verdict: String, barcode: String },
    #[error("the settings have no such lane or plan")]
    NoLaneOrPlan,
    #[error("the system has no thread for it ({error}); end other programs")]
    NoThread { error: String },
    #[error(
        "the hooks are not started: those of {verdicts} earlier verdicts are not done; look at what they drive"
    )]
    HooksBehind { verdicts: usize },
    #[error("the board is a {kind}, but the plan takes only hardware")]
    HardwareAlone { kind: String },
    #[error("the board's build is {build}, but the plan takes {builds}")]
    BuildNotOfPlan { build: String, builds: String },
    #[error("the board does not say which device it is, but the plan asks for it")]
    DeviceAskedFor,
    #[error("the board does not say which device it is")]
    DeviceUnsaid,
    #[error("{name} ({kind}), build {build}, {IDENTITY_NOT_CHECKED}", IDENTITY_NOT_CHECKED = crate::record::IDENTITY_NOT_CHECKED)]
    IdentityUnchecked { name: String, kind: String, build: String },
    #[error("{name} ({kind}), build {build}, device {device}")]
    DeviceKnown { name: String, kind: String, build: String, device: String },
    #[error("{name} ({kind}), build {build}, device {device}, seen for the first time")]
    DeviceNew { name: String, kind: String, build: String, device: String },
    #[error("the run was stopped before the board was judged")]
    StoppedBefore,
    #[error(
        "the board is held by another session: a run that was killed, or another computer that uses it; scan the label again \
         in {seconds:.0} s"
    )]
    StillHeld { seconds: f64 },
    #[error("not retried automatically: the board showed a fault")]
    NotRepeatedWrong,
    #[error(
        "not retried automatically: the board or its connection was away, and the board may be at fault, or another one now"
    )]
    NotRepeatedLost,
    #[error("the link was tested: {link}")]
    LinkTested { link: String },
    #[error("{} {} other bytes than were sent, with a right CRC", count(*.wrong, "answer"), verb(*.wrong, "hold"))]
    LinkAnswersWrong { wrong: u64 },
    #[error("the board was exchanged during the run: {first} became {now}")]
    BoardSwapped { first: String, now: String },
    #[error("device {device} is being tested in another lane")]
    DeviceElsewhere { device: String },
    #[error("this board is {serial} of {product}; you scanned {scanned}")]
    OtherProduct { serial: String, product: String, scanned: String },
    #[error("this board is {serial}; you scanned {scanned}")]
    OtherSerial { serial: String, scanned: String },
    #[error("{serial} is device {device}; the board in the lane is device {found}")]
    OtherDevice { serial: String, device: String, found: String },
    /// What was measured is beyond a limit of the plan.
    #[error("{sentence}")]
    BeyondLimit {
        sentence: String,
        name: String,
        value: f64,
        unit: String,
        low: Option<f64>,
        high: Option<f64>,
    },
    /// What the plan has a limit for was not measured.
    #[error("{sentence}")]
    NotMeasured { sentence: String, name: String, unit: String, low: Option<f64>, high: Option<f64> },
    #[error("{passed} of {} passed, and nothing is known of the others", count(*.planned, "step"))]
    StepsUnknown { passed: usize, planned: u32 },
    #[error("not reached")]
    StepNotReached,
    #[error("the lane sent a line that is no message: {line}")]
    LaneBabbles { line: String },
    #[error("the lane is not of this station's program, which is {program}; start the station again")]
    LaneOfOtherProgram { program: String },
    #[error("the lane ended before it was done ({status})")]
    LaneDied { status: String },
    #[error("the lane could not be started: {error}")]
    LaneNotStarted { error: String },
    #[error("the lane sent nothing for {seconds} s")]
    LaneSilent { seconds: f64 },
    #[error("the lane took longer than {seconds} s")]
    LaneLate { seconds: f64 },
    #[error("the lane did not end within {seconds} s of being told to")]
    LaneDeaf { seconds: f64 },
    #[error("{why}, and could not even be killed")]
    LaneStuck { why: Said },
    #[error("the lane did not end, and could not even be killed")]
    LaneEndless,
    #[error(
        "a file that the plan names was changed since the plan was read; put it back, or start the station again, and then \
         test the board again"
    )]
    PlanChanged,
    #[error(
        "the file {file}, which the plan names, has changed since the station started; put it back, or give the plan a \
         new version and start the station again"
    )]
    PlanFileOther { file: String },
    #[error("the station ended in the middle of the run ({} of its steps on record)", count(*.tries, "try"))]
    StationEnded { tries: usize },
    #[error("the result could not be saved when the run was over ({} of its steps on record)", count(*.tries, "try"))]
    SavedTooLate { tries: usize },
    #[error("the result is saved here, but not at the plant yet; the lane waits for the plant")]
    NotAtPlant,
    #[error(
        "{} {} not at the plant yet, and at most {most} may wait; look at the network and the plant",
        count(*.entries, "result"), verb(*.entries, "are")
    )]
    TooMuchUnsent { entries: u32, most: u32 },
    #[error("the disk is {percent} % full; make room on it, or have the plant take what is unsent")]
    DiskTooFull { percent: u64 },
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use halfrow::board::BoardError;
    use halfrow::result::codes;

    use crate::run::RunError;
    use crate::store::StoreError;

    #[test]
    fn a_board_that_another_session_holds_is_scanned_again_and_not_taken_over() {
        let told = Said::of(&BoardError::Held { seconds: 6.6 }).at_the_station();
        assert!(told.message.ends_with("; scan the label again in 7 s"), "{told}");
        assert_eq!(told.scan_again().as_deref(), Some("Scan the label again in 7 s."));
        let other = Said::of(&BoardError::SessionLost { silent: Duration::ZERO }).at_the_station();
        assert_eq!((other.code.as_str(), other.scan_again()), ("session-lost", None), "the control");
    }

    /// The codes are those of docs/STATION-CODES.md.
    #[test]
    fn a_log_has_the_codes_of_an_error_and_of_its_causes_behind_their_sentences() {
        let error = RunError::NotBegun(Box::new(StoreError::ClockApart { minutes: 7 }));
        let said = Said::of(&error);
        assert_eq!(said.with_codes(), format!("{said} (run-not-begun, clocks-apart)"));
        let uncoded = Said::uncoded("no".to_owned());
        assert_eq!(uncoded.with_codes(), "no", "there is none");
        let refused =
            Said { code: "plant-refuses".to_owned(), causes: vec![uncoded.clone()], ..uncoded.clone() };
        assert_eq!(refused.with_codes(), "no: no (plant-refuses)");
        let foreign = Said { code: "foreign-cause".to_owned(), ..uncoded };
        assert_eq!(
            Said { causes: vec![foreign], ..refused }.with_codes(),
            "no: no (plant-refuses)",
            "which says nothing"
        );
    }

    #[test]
    fn every_code_of_an_absent_board_is_one_of_the_judge() {
        for code in ABSENT {
            let mut known = codes::LISTS.into_iter().flatten().flat_map(|list| list.codes);
            assert!(known.any(|(known, _)| *known == code), "{code}");
        }
    }
}

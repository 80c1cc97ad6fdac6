//! How a run must end.

use std::fmt;

use serde_json::Value;

use crate::not_tested::not_tested;
use crate::parallel;
use crate::program::documents::headline;
use crate::program::{Ended, halfrow};
use crate::served::Served;

/// The boards on which a scenario makes sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    /// Every kind.
    AnyBoard,
    /// Those with a wire in this process, which options can slow down or spoil: the mock and the simulated Verilog.
    OwnWire,
    /// The mock alone, since options can build and break it.
    MockOnly,
}

/// How much of a scenario the simulated board without pins takes. `scripts/soak pins` has it take all, through its pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnSim {
    /// All.
    Whole,
    /// Rows alone: bursts would tell of the Verilog what those of others do, and take as long as all the rest of a run.
    Stepped,
    /// Nothing: it takes long, or differs from others in what the Verilog does not know of.
    Nothing,
}

/// A board, a call, and its expected result.
#[derive(Clone, Copy, Debug)]
pub struct Scenario {
    /// What is tried, in a few words.
    pub name: &'static str,
    /// Where it runs.
    pub on: On,
    /// What is appended to the board's target, such as `,fault=late`.
    pub options: &'static str,
    /// Further arguments of `verify`. Without a width it is the paper's system, which a simulated board runs at a smaller size.
    pub arguments: &'static [&'static str],
    /// `PASS`, `FAIL` or `ERROR`; empty, for null, when the call itself is refused.
    pub verdict: &'static str,
    /// The exit code.
    pub exit_code: i32,
    /// What the headline or the first suspect must say.
    pub sentence: &'static str,
    /// What it may say instead where host and board both keep real time, since then it depends on which of them is late.
    pub when_late: &'static [&'static str],
    /// Whether it takes ten seconds and more behind an emulated chip, or simulated.
    pub is_slow: bool,
    /// How much of it the simulated board takes without pins.
    pub on_sim: OnSim,
}

/// A scenario that did not end as expected.
#[derive(Clone, Debug)]
pub struct Surprise {
    scenario: Scenario,
    board: String,
    ended: Ended,
}

impl fmt::Display for Surprise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scenario, board, ended } = self;
        let Scenario { name, options, arguments, verdict, exit_code, sentence, .. } = scenario;
        writeln!(f, "{name}: expected {verdict} with {exit_code} and `{sentence}` of")?;
        writeln!(f, "  halfrow verify --json --board {board}{options} {}", arguments.join(" "))?;
        let said = ended.json();
        let what = headline(&said);
        writeln!(f, "  and it ended with {:?}, {} {what}", ended.code, said["verdict"])?;
        writeln!(f, "  suspects: {}", said["suspects"])?;
        write!(f, "  stderr: {}", ended.stderr)
    }
}

/// The paper's lens with fewer pixels.
pub(crate) const SMALLER: &[&str] = &["--width", "128", "--height", "72", "--radius", "73.78"];

/// Rows alone, without a burst.
const STEPPED: &[&str] = &["--at-speed", "0"];

/// Whether the board that `target` names runs in the program that judges it, and so is never late.
fn is_in_process(target: &str) -> bool {
    ["mock", "sim"].contains(&kind(target))
}

/// Whether `target` is the simulated board whose bytes do not go through the pins of a chip.
fn is_sim_without_pins(target: &str) -> bool {
    target.split(',').next() == Some("sim")
}

/// The kind of board that a target names.
fn kind(board: &str) -> &str {
    board.split([':', ',']).next().unwrap_or(board)
}

impl Scenario {
    /// Whether it makes sense on `board`, a target.
    #[must_use]
    pub fn suits(&self, board: &str) -> bool {
        let is_left_out = self.on_sim == OnSim::Nothing && is_sim_without_pins(board);
        !is_left_out
            && match self.on {
                On::AnyBoard => true,
                On::OwnWire => is_in_process(board),
                On::MockOnly => kind(board) == "mock",
            }
    }

    /// The same scenario, which may also end with one of these `sentences` where either end may be late.
    pub(crate) const fn or_when_late(self, sentences: &'static [&'static str]) -> Self {
        Self { when_late: sentences, ..self }
    }

    /// The same scenario, which takes long.
    pub(crate) const fn slow(self) -> Self {
        Self { is_slow: true, ..self.on_sim(OnSim::Nothing) }
    }

    /// The same scenario, of which the simulated board takes so much.
    pub(crate) const fn on_sim(self, on_sim: OnSim) -> Self {
        Self { on_sim, ..self }
    }

    /// The same scenario for other boards.
    pub(crate) const fn on(self, on: On) -> Self {
        Self { on, ..self }
    }

    /// Whether it names the size of its frames, and so is not of the paper's size.
    #[must_use]
    pub fn has_own_size(&self) -> bool {
        self.arguments.contains(&"--width")
    }

    /// Runs it on `board`, a target, and returns the report as JSON.
    ///
    /// # Errors
    /// [`Surprise`] when it does not end as expected.
    pub fn run(&self, board: &str) -> Result<Value, Box<Surprise>> {
        self.judge(&format!("{board}{}", self.options), board)
    }

    /// Runs it on the mock board behind a pseudo-terminal.
    ///
    /// # Errors
    /// Like [`Self::run`].
    pub fn run_on_a_serial_port(&self) -> Result<Value, Box<Surprise>> {
        let served = Served::on_a_serial_port(&format!("mock{}", self.options));
        self.judge(&served.target(), "mock behind a serial port: ")
    }

    /// Judges `target`, which leads to `board` with the scenario's options.
    ///
    /// # Errors
    /// Like [`Self::run`].
    pub fn judge(&self, target: &str, board: &str) -> Result<Value, Box<Surprise>> {
        let smaller = if kind(target) == "sim" && !self.has_own_size() { SMALLER } else { &[] };
        let stepped =
            if self.on_sim == OnSim::Stepped && is_sim_without_pins(target) { STEPPED } else { &[] };
        let arguments = self.arguments.iter().chain(smaller).chain(stepped).copied();
        let ended = halfrow(["verify", "--json", "--board", target].into_iter().chain(arguments));
        let said = ended.json();
        let when_late = if is_in_process(target) { &[] } else { self.when_late };
        let expected = [&[self.sentence], when_late].concat();
        let as_expected = ended.code == Some(self.exit_code)
            && said["exit_code"] == self.exit_code
            && said["verdict"].as_str().unwrap_or_default() == self.verdict
            && sentences(&said).any(|sentence| expected.iter().any(|words| sentence.contains(words)));
        if as_expected {
            return Ok(said);
        }
        Err(Box::new(Surprise { scenario: *self, board: board.to_owned(), ended }))
    }
}

/// Runs those of `scenarios` that suit `board`, and returns their reports.
///
/// # Panics
/// When any of them does not end as expected.
#[must_use]
pub fn run_all(scenarios: &[Scenario], board: &str) -> Vec<Value> {
    run_each(&scenarios.iter().collect::<Vec<_>>(), board)
}

/// Like [`run_all`], for a choice of scenarios.
///
/// # Panics
/// Like [`run_all`].
#[must_use]
pub fn run_each(scenarios: &[&Scenario], board: &str) -> Vec<Value> {
    let suited: Vec<_> = scenarios.iter().filter(|scenario| scenario.suits(board)).collect();
    no_surprise(if is_in_process(board) {
        parallel::map(&suited, |scenario| scenario.run(board))
    } else {
        // There is only one device.
        suited.iter().map(|scenario| scenario.run(board)).collect()
    })
}

/// Runs `scenarios` on mock boards behind serial ports of their own, and returns their reports.
///
/// # Panics
/// When any of them does not end as expected, or there is none.
#[must_use]
pub fn run_all_on_serial_ports(scenarios: &[&Scenario]) -> Vec<Value> {
    assert!(!scenarios.is_empty(), "no scenario would pass for all of them");
    no_surprise(parallel::map(scenarios, |scenario| scenario.run_on_a_serial_port()))
}

fn no_surprise(results: Vec<Result<Value, Box<Surprise>>>) -> Vec<Value> {
    let runs = results.len();
    let (reports, surprises): (Vec<_>, Vec<_>) = results.into_iter().partition(Result::is_ok);
    let surprises: Vec<_> = surprises.into_iter().filter_map(Result::err).map(|it| it.to_string()).collect();
    assert!(surprises.is_empty(), "{} of {runs}:\n{}", surprises.len(), surprises.join("\n"));
    reports.into_iter().filter_map(Result::ok).collect()
}

/// Runs those of `scenarios` that suit each of the boards of `HALFROW_TEST_BOARDS`, targets separated by spaces, or else the
/// mock, and returns their reports. A board that none of them suits is reported as not tested by them.
///
/// # Panics
/// When any of them does not end as expected, or the variable names no board.
pub fn run_all_on_boards(scenarios: &[Scenario]) -> Vec<Value> {
    let named = std::env::var("HALFROW_TEST_BOARDS").unwrap_or_else(|_| "mock".to_owned());
    let boards: Vec<_> = named.split_whitespace().collect();
    assert!(!boards.is_empty(), "HALFROW_TEST_BOARDS names no board; name one, as in mock, or unset it");
    boards.into_iter().flat_map(|board| run_those_that_suit(scenarios, board)).collect()
}

fn run_those_that_suit(scenarios: &[Scenario], board: &str) -> Vec<Value> {
    if !scenarios.iter().any(|scenario| scenario.suits(board)) {
        let first = scenarios.first().map_or("", |scenario| scenario.name);
        let what = format!("{} scenarios, `{first}` the first of them", scenarios.len());
        not_tested(&what, &format!("none of them suits {board}"));
    }
    run_all(scenarios, board)
}

/// The headline, and the place of the first suspect and the evidence for it.
fn sentences(said: &Value) -> impl Iterator<Item = String> {
    let suspect = &said["suspects"][0];
    let of_suspect = ["place", "evidence"].into_iter().filter_map(|key| suspect[key].as_str());
    std::iter::once(headline(said)).chain(of_suspect.map(str::to_owned))
}

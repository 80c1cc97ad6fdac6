//! Tries on purpose what no frame shows: what a board must refuse, keep, end and send again (WIRE.md, AT-SPEED.md).
//!
//! It is done with rows of the least width, so that it takes little time on a link, and last, because it leaves the board
//! without tables.

mod banks;
mod bursts;
mod commits;
mod compared;
mod configurations;
mod counts;
mod depths;
mod greetings;
mod grids;
mod marked;
mod posed;
mod power_up;
mod price;
mod quoted;
mod refusals;
mod requests;
mod rows;
mod sessions;
mod small;
mod tables;
mod trap;
mod waiting;
mod wide;
mod windows;
mod without_effect;

use halfrow_model::{Geometry, Phase};
use halfrow_protocol::Kind;
use halfrow_protocol::message::{Bank, Refusal, RefusalCode, Request, Span, Table};

use super::at_speed::known_bursts;
use super::findings::{During, End};
use super::plan::Segment;
use super::plan::parts::of_height;
use super::steps::Run;
use crate::board::{BoardError, Capabilities, Datapath, Given, Had, Response, RowTiming, Status};
use crate::compare::Comparison;
use crate::progress::Step;
use crate::result::{Answer, CheckName, Counter, Doubt, Finding, Lead, RowPart, RowsTried, Rule, Suspect};
use crate::verdict::Cause;
use compared::{Compared, WrongRow};
use posed::Posed;
pub(super) use price::price;
pub(super) use quoted::answer;
use refusals::Refusals;
use small::Small;
pub(super) use trap::tallest_of_rules;
pub(super) use waiting::MOST_FILLED;
pub(super) use windows::window_wrong;

/// The first row factor of the shadow bank.
const FIRST_FACTOR: Span = Span { table: Table::RowFactors, bank: Bank::Shadow, port: 0, first: 0, count: 1 };

/// How often a board must count a row as known that it took without an answer.
const TIMES_KNOWN: u32 = 3;

/// Rows of the frames that a board is given for the rules, and of those among them that are as wide as it takes.
pub(super) fn rows_of_rules(capabilities: &Capabilities) -> (usize, usize) {
    let most = usize::from(capabilities.max_height);
    (small::ROWS.min(most), wide::ROWS.min(most))
}

/// Sizes, depths and centres of these frames.
pub(super) fn geometries_of_rules(capabilities: &Capabilities, seed: u64, phase: Phase) -> Vec<Geometry> {
    let small = Small::new(capabilities, seed, phase).map(|small| small.geometry);
    let wide = small.and_then(|small| wide::geometry(capabilities, small.depth()));
    small.into_iter().chain(wide).collect()
}

impl Run<'_> {
    /// Tries the rules. If the board goes away meanwhile, it is brought back to where it was after `last`.
    pub(super) fn rules(&mut self, last: Option<&Segment>) -> Result<(), End> {
        if !self.plan.tries_rules() {
            return Ok(());
        }
        self.progress.step(Step::Rules);
        self.persist(last, |run| {
            let Some(rules) = Rules::new(run) else {
                run.findings.checks.skipped(CheckName::Rules, Finding::RulesLeftOut {});
                return Ok(());
            };
            let tried = match rules.all() {
                Err(end) if end.is_failed() => Err(end),
                tried => run.unless_misconduct(CheckName::Rules, tried),
            };
            let requests = tried?;
            run.findings.checks.passed(CheckName::Rules, Finding::RulesKept { requests });
            Ok(())
        })
    }
}

/// A board whose rules are tried.
struct Rules<'a, 'run> {
    run: &'a mut Run<'run>,
    capabilities: Capabilities,
    small: Small,
    /// How many requests were answered as they must be.
    right: usize,
    /// The refusals among these, in the open session.
    refusals: Refusals,
    /// The board's counters before these.
    before: Status,
    /// The columns of a frame in the board's present configuration.
    width: usize,
    /// The rows of a frame in it.
    height: usize,
    /// Rows of the next frame that were already given to the board.
    given: Given,
    /// The frame of a commit that is pending, while what the board answers depends on it.
    pending: Option<u16>,
    /// Whether a session ended that this host did not end, which was no reason to fail.
    has_lost_session: bool,
}

impl<'a, 'run> Rules<'a, 'run> {
    fn new(run: &'a mut Run<'run>) -> Option<Self> {
        let capabilities = run.board.capabilities.clone();
        let small = Small::new(&capabilities, run.plan.seed, run.plan.phase)?;
        Some(Self {
            run,
            capabilities,
            small,
            right: 0,
            refusals: Refusals::default(),
            before: Status::default(),
            width: 0,
            height: 0,
            given: Given::default(),
            pending: None,
            has_lost_session: false,
        })
    }

    /// Tries all rules, and returns how many requests were answered as they must be.
    fn all(mut self) -> Result<usize, End> {
        match self.each() {
            Err(end) if end.is_not_ready() => Err(self.reset_too_far().unwrap_or(end)),
            Ok(()) if self.has_lost_session => {
                self.run.sessions.note_lost();
                Ok(self.right)
            }
            tried => tried.map(|()| self.right),
        }
    }

    fn each(&mut self) -> Result<(), End> {
        self.drop_rows()?;
        self.before = self.status()?;
        self.requests()?;
        self.tables()?;
        self.damage()?;
        self.other_sessions()?;
        self.commits()?;
        self.rows()?;
        self.counts_stay()?;
        self.refusals_counted()?;
        self.counts()?;
        self.answered_once()?;
        self.sessions()?;
        self.wide()?;
        if known_bursts(&self.capabilities).is_ok() {
            self.bursts()?;
            self.trap()?;
        }
        self.refusals_counted()?;
        self.power_up()?;
        self.closed()
    }

    /// Ends with anything `said` but the answer `right`. A reply may be longer than that.
    fn judge(
        &mut self,
        rule: Rule,
        posed: Posed,
        said: Result<Response, BoardError>,
        right: &Response,
    ) -> Result<(), End> {
        let (right, found) = match said {
            Ok(said) if is_as(&said, right) => {
                self.right += 1;
                self.refusals.note(right);
                return Ok(());
            }
            Ok(said) => quoted::answers(posed.kind, right, &said),
            Err(BoardError::NoAnswer { heard, .. }) if heard.damaged == 0 && self.had_it_each_time() => {
                return Err(unanswered(rule, posed, answer(right)));
            }
            Err(BoardError::Unanswered { had: Had::Counted, .. }) => {
                return Err(unanswered(rule, posed, answer(right)));
            }
            Err(error) => return Err(End::board(CheckName::Rules, &error)),
        };
        Err(broken(rule, posed, right, found))
    }

    /// Whether the board answers and had every packet that was sent to it: only then is it known what it did not answer.
    fn had_it_each_time(&mut self) -> bool {
        self.run.board.status().is_ok_and(|status| self.run.board.had_each_packet_once(&status))
    }

    /// Sends a request that must be refused.
    fn refused(
        &mut self,
        rule: Rule,
        request: &Request<'_>,
        code: RefusalCode,
        detail: u16,
    ) -> Result<(), End> {
        self.bytes_refused(rule, request.kind(), &payload(request), code, detail)
    }

    fn bytes_refused(
        &mut self,
        rule: Rule,
        kind: Kind,
        payload: &[u8],
        code: RefusalCode,
        detail: u16,
    ) -> Result<(), End> {
        let changes = self.run.board.repeated_changes();
        let said = self.run.board.ask(kind, payload);
        let posed = self.posed();
        let right = Response::Refused(Refusal { code, kind: kind.code(), detail });
        let is_unanswered = matches!(said, Err(BoardError::NoAnswer { .. } | BoardError::Unanswered { .. }));
        if is_unanswered
            && kind == Kind::RowIn
            && (0..TIMES_KNOWN).all(|_| self.is_known_when_sent_again(payload))
        {
            // It is known what happened to each copy of this request.
            self.run.board.excuse_changes(changes);
            return Err(broken(rule, posed, answer(&right), Answer::Taken {}));
        }
        self.judge(rule, posed, said, &right)
    }

    /// What `marked` came to, a request with something that must be ignored. If it broke a rule, and does so without that as
    /// well, as `plain` tries, ends with the latter.
    fn or_plain(
        &mut self,
        marked: Result<(), End>,
        plain: impl FnOnce(&mut Self) -> Result<(), End>,
    ) -> Result<(), End> {
        match marked {
            Err(found) if found.is_failed() => {
                let changes = self.run.board.repeated_changes();
                Err(plain(self).err().filter(End::is_failed).unwrap_or_else(|| {
                    // Whatever came of that cannot have caused what was found before it.
                    self.run.board.excuse_changes(changes);
                    found
                }))
            }
            ended => ended,
        }
    }

    /// Whether the board has the row in `payload`, by what it counts when that comes once more, and surely comes.
    fn is_known_when_sent_again(&mut self, payload: &[u8]) -> bool {
        let Ok(alone) = self.alone(|board| board.give_bytes(Kind::RowIn, payload)) else { return false };
        let known = |status: &Status| u64::from(status.rows_unneeded) + u64::from(status.rows_repeated);
        let is_refused = alone.after.refusals > alone.before.refusals;
        known(&alone.after) > known(&alone.before) && !is_refused && alone.has_surely_come()
    }

    /// Sends a request that must be answered with `reply`.
    fn replied(&mut self, rule: Rule, request: &Request<'_>, reply: Vec<u8>) -> Result<(), End> {
        self.bytes_replied(rule, request.kind(), &payload(request), reply)
    }

    fn bytes_replied(&mut self, rule: Rule, kind: Kind, payload: &[u8], reply: Vec<u8>) -> Result<(), End> {
        let said = self.run.board.ask(kind, payload);
        self.judge(rule, self.posed(), said, &Response::Replied(reply))
    }

    /// Configures the board for small frames of `rows` rows.
    fn configure(&mut self, rows: usize) -> Result<(), End> {
        let geometry = of_height(&self.small.geometry, rows);
        self.set(&geometry, RowTiming::default())
    }

    fn set(&mut self, geometry: &Geometry, timing: RowTiming) -> Result<(), End> {
        (self.width, self.height) = (geometry.width(), geometry.height());
        self.run.board.configure(geometry, timing, Datapath::RowFactors).during(CheckName::Rules)
    }

    fn status(&mut self) -> Result<Status, End> {
        self.run.board.status().during(CheckName::Rules)
    }

    fn drop_rows(&mut self) -> Result<(), End> {
        self.run.board.drop_rows().during(CheckName::Rules)
    }

    /// Streams the frames of `compared`, which must come back right.
    fn frames(&mut self, rule: Rule, mut compared: Compared) -> Result<(), End> {
        self.stream(&mut compared).map_err(|error| of_rows(rule, error))?;
        self.judge_rows(rule, &compared)
    }

    /// Ends with the first wrong row. If only its samples are wrong and a known defect explains them, the finding is that
    /// samples differ, not that a rule is broken.
    fn judge_rows(&self, rule: Rule, compared: &Compared) -> Result<(), End> {
        let Some(WrongRow { row, frame, seen, differs }) = &compared.wrong else { return Ok(()) };
        if let Some(seen) = seen {
            let suspects = self.run.diagnose_rows(seen, "rules", *frame);
            if suspects.first().is_some_and(Suspect::is_known) {
                let compared = Comparison::of_frames(&seen.evidence.expected, &seen.evidence.found);
                let expected = &seen.evidence.expected;
                let tried = RowsTried { width: expected.width(), height: expected.height() };
                let Lead { suspect, others, short } = Lead::of(&suspects);
                let finding = Finding::SamplesDiffer {
                    differences: compared.differences,
                    samples: compared.samples,
                    differing_frames: 1,
                    frames: 1,
                    tried: Some(Box::new(tried)),
                    suspect,
                    others,
                    short,
                };
                return Err(End::suspecting(CheckName::Rules, finding, suspects));
            }
        }
        Err(other_row(rule, *row, *frame, differs.clone()))
    }

    fn stream(&mut self, compared: &mut Compared) -> Result<(), BoardError> {
        let given = std::mem::take(&mut self.given);
        self.run.board.stream_given(given, compared)
    }
}

/// The end of waiting for rows that must come back.
fn of_rows(rule: Rule, error: BoardError) -> End {
    match error {
        BoardError::RowMissing { place, .. } => {
            let right = Answer::Row { row: place.row.into(), frame: place.frame };
            unanswered(rule, Kind::RowIn, right)
        }
        error => End::board(CheckName::Rules, &error),
    }
}

fn miscounted(rule: Option<Rule>, counter: Counter, counted: u32, right: u32) -> End {
    End::failed(CheckName::Rules, counter_wrong(rule, counter, counted, right))
}

fn counter_wrong(rule: Option<Rule>, counter: Counter, counted: u32, right: u32) -> Finding {
    Finding::CounterWrong { counter, counted, right, rule }
}

fn broken(rule: Rule, posed: impl Into<Posed>, right: Answer, found: Answer) -> End {
    End::failed(CheckName::Rules, rule_broken(rule, posed, right, found))
}

/// An answer that must be given did not come, however often it was asked for. Silence alone makes no board wrong, since a
/// link can lose the same packet each time, or all packets for a while.
fn unanswered(rule: Rule, posed: impl Into<Posed>, right: Answer) -> End {
    doubted(rule_broken(rule, posed, right, Answer::Nothing {}), Doubt::AnswerLost {})
}

/// Something was `found` that the link may have caused each time.
fn doubted(found: Finding, doubt: Doubt) -> End {
    let finding = Finding::WrongOverDoubtfulLink { found: Box::new(found), doubt };
    End::error(CheckName::Rules, Cause::Station, finding)
}

fn rule_broken(rule: Rule, posed: impl Into<Posed>, right: Answer, found: Answer) -> Finding {
    let Posed { kind, asked } = posed.into();
    Finding::RuleBroken { rule, request: kind.to_string(), right, found, asked }
}

fn other_row(rule: Rule, row: usize, frame: u16, differs: Vec<RowPart>) -> End {
    broken(rule, Kind::RowIn, Answer::Row { row, frame }, Answer::OtherRow { differs: differs.into() })
}

fn payload(request: &Request<'_>) -> Vec<u8> {
    let mut payload = Vec::new();
    request.write(&mut payload);
    payload
}

/// The payload of `request` with a byte after its fields.
fn longer(request: &Request<'_>) -> Vec<u8> {
    let mut payload = payload(request);
    payload.push(requests::NO_MEANING);
    payload
}

fn is_as(said: &Response, right: &Response) -> bool {
    match (said, right) {
        (Response::Replied(said), Response::Replied(right)) => said.starts_with(right),
        (said, right) => said == right,
    }
}

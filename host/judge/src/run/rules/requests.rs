//! Requests that no host makes: cut short, without meaning, or too long.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{
    Burst, BurstMode, Commit, Entries, Expect, RefusalCode, Request, Reset, ResetLevel, Span, Table,
};

use super::tables::RIGHT;
use super::{FIRST_FACTOR, Rules, answer, broken, longer, payload};
use crate::board::Response;
use crate::result::Rule;
use crate::run::at_speed::known_bursts;
use crate::run::findings::End;

/// A value that has no meaning in any byte with few values.
pub(super) const NO_MEANING: u8 = 0x80;
/// From this bit on, no level or mode has a bit set.
const FIRST_BIT: u32 = 2;
/// Of levels and banks, what has no meaning although it is made of the bits of others.
const NO_LEVEL: u8 = 3;
const NO_BANK: u8 = 3;

impl Rules<'_, '_> {
    pub(super) fn requests(&mut self) -> Result<(), End> {
        self.cut_short()?;
        self.without_meaning()?;
        for kind in self.unknown() {
            self.bytes_refused(Rule::Kind, kind, &[], RefusalCode::Kind, 0)?;
        }
        self.longer()?;
        self.echo_of_nothing()
    }

    /// Kinds that are no requests, or none that the board knows. One that makes frames of unknown content may know more.
    fn unknown(&self) -> Vec<Kind> {
        let has_none = self.capabilities.bursts.is_none();
        let bursts = has_none.then_some([Kind::Burst, Kind::Records]);
        let is_known = has_none || known_bursts(&self.capabilities).is_ok();
        let trap = (is_known && !self.has_trap()).then_some([Kind::Expect, Kind::Trap]);
        let of_bursts = bursts.into_iter().chain(trap).flatten();
        [Kind::RowOut, Kind::Refusal].into_iter().chain(of_bursts).collect()
    }

    /// An echo must be exact: it has no fields after which more bytes might follow.
    fn echo_of_nothing(&mut self) -> Result<(), End> {
        let said = self.run.board.ask(Kind::Echo, &[]);
        let posed = self.posed();
        match said {
            Ok(Response::Replied(more)) if !more.is_empty() => {
                let nothing = Response::Replied(Vec::new());
                Err(broken(Rule::Skipped, posed, answer(&nothing), answer(&Response::Replied(more))))
            }
            said => self.judge(Rule::Skipped, posed, said, &Response::Replied(Vec::new())),
        }
    }

    /// Requests with a byte after their fields, which must be skipped.
    fn longer(&mut self) -> Result<(), End> {
        let span = Span { count: 0, ..FIRST_FACTOR };
        let next_row = self.run.board.credit();
        let empty = Request::TableRead(span);
        let requests = [
            // Capabilities and counters are judged by other checks.
            (Request::Capabilities, Vec::new()),
            (Request::Status { clear: false }, Vec::new()),
            (Request::TableWrite(Entries { span, bytes: &[] }), Vec::new()),
            (empty, payload(&empty)),
            (Request::TableCrc(span), crc32fast::hash(&[]).to_le_bytes().to_vec()),
            (Request::Configure(self.configuration()), Vec::new()),
            (Request::Reset(Reset { level: ResetLevel::Rows, next_row }), Vec::new()),
        ];
        for (request, reply) in requests {
            self.bytes_replied(Rule::Skipped, request.kind(), &longer(&request), reply)?;
        }
        self.drop_rows()
    }

    /// Every request that has fields, a byte too short.
    fn cut_short(&mut self) -> Result<(), End> {
        let span = Span { count: 0, ..FIRST_FACTOR };
        let commit = Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: 1, shape: None };
        let requests = [
            Request::TableWrite(Entries { span: FIRST_FACTOR, bytes: &RIGHT.to_le_bytes() }),
            Request::TableRead(span),
            Request::TableCrc(span),
            Request::Commit(commit),
            Request::Configure(self.configuration()),
        ];
        let bursts = self.no_burst().map(|burst| [Request::Burst(burst), Request::Records { from: 0 }]);
        let expect = Request::Expect(Expect { first: 0, bytes: &[[0; Expect::BYTES]] });
        let expect = (bursts.is_some() && self.has_trap()).then_some(expect);
        for request in requests.into_iter().chain(bursts.into_iter().flatten()).chain(expect) {
            let (kind, whole) = (request.kind(), payload(&request));
            self.malformed(kind, &whole[..whole.len() - 1])?;
        }
        self.malformed(Kind::Status, &[])?;
        self.malformed(Kind::Reset, &[0; 4])
    }

    /// Requests with a field that has no meaning.
    fn without_meaning(&mut self) -> Result<(), End> {
        let bits = (FIRST_BIT..u8::BITS).map(|bit| 1 << bit);
        for level in bits.clone().chain([NO_LEVEL]) {
            self.malformed(Kind::Reset, &[level, 0, 0, 0, 0])?;
        }
        let burst = self.no_burst().map(|burst| payload(&Request::Burst(burst)));
        for (mode, mut burst) in bits.flat_map(|mode| burst.clone().map(|burst| (mode, burst))) {
            burst.pop();
            burst.push(mode);
            self.malformed(Kind::Burst, &burst)?;
        }
        // No table and no bank is one of these bits alone.
        let bits = (1..u8::BITS).map(|bit| 1 << bit);
        let grid = self.capabilities.grids.is_none().then_some(Table::Grid as u8);
        let tables = bits.clone().chain(grid).map(|table| [table, 0]);
        for [table, bank] in tables.chain(bits.chain([NO_BANK]).map(|bank| [0, bank])) {
            for kind in [Kind::TableWrite, Kind::TableRead, Kind::TableCrc] {
                self.malformed(kind, &[table, bank, 0, 0, 0, 0, 0])?;
            }
        }
        Ok(())
    }

    /// A burst that the board must refuse, if it makes any.
    fn no_burst(&self) -> Option<Burst> {
        known_bursts(&self.capabilities).ok().map(|bursts| Burst {
            burst: 0,
            frames: 0,
            seed: 0,
            first_frame: 0,
            frame_blanking: bursts.least_frame_blanking,
            mode: BurstMode::Fresh,
        })
    }

    fn malformed(&mut self, kind: Kind, payload: &[u8]) -> Result<(), End> {
        self.bytes_refused(Rule::Payload, kind, payload, RefusalCode::Payload, 0)
    }
}

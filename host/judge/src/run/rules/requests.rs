//! Requests that no host makes: cut short, without meaning, or too long.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{
    Burst, BurstMode, Commit, Entries, RefusalCode, Request, Reset, ResetLevel, Span,
};

use super::{FIRST_FACTOR, Rules, answer, broken, longer, payload};
use crate::board::Response;
use crate::result::Rule;
use crate::run::at_speed::known_bursts;
use crate::run::findings::End;

/// A value that has no meaning in any byte with few values.
pub(super) const NO_MEANING: u8 = 0x80;
/// From this bit on, no level, table, bank or mode has a bit set.
const FIRST_BIT: u32 = 2;
impl Rules<'_, '_> {
    pub(super) fn requests(&mut self) -> Result<(), End> {
        self.without_meaning()?;
        for kind in [Kind::RowOut, Kind::Refusal] {
            self.bytes_refused(Rule::Kind, kind, &[], RefusalCode::Kind, 0)?;
        }
        self.longer()?;
        self.echo_of_nothing()
    }

    /// An echo must be exact: it has no fields after which more bytes might follow.
    fn echo_of_nothing(&mut self) -> Result<(), End> {
        match self.run.board.ask(Kind::Echo, &[]) {
            Ok(Response::Replied(more)) if !more.is_empty() => {
                let nothing = Response::Replied(Vec::new());
                Err(broken(Rule::Skipped, Kind::Echo, answer(&nothing), answer(&Response::Replied(more))))
            }
            said => self.judge(Rule::Skipped, Kind::Echo, said, &Response::Replied(Vec::new())),
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

    /// Every request a byte too short, and with a field that has no meaning.
    fn without_meaning(&mut self) -> Result<(), End> {
        let span = Span { count: 0, ..FIRST_FACTOR };
        let commit = Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: 1, shape: None };
        let burst = known_bursts(&self.capabilities).ok().map(|bursts| Burst {
            burst: 0,
            frames: 0,
            seed: 0,
            first_frame: 0,
            frame_blanking: bursts.least_frame_blanking,
            mode: BurstMode::Fresh,
        });
        let requests = [
            Request::TableRead(span),
            Request::TableCrc(span),
            Request::Commit(commit),
            Request::Configure(self.configuration()),
        ];
        let bursts =
            burst.into_iter().flat_map(|burst| [Request::Burst(burst), Request::Records { from: 0 }]);
        for request in requests.into_iter().chain(bursts) {
            let (kind, whole) = (request.kind(), payload(&request));
            self.malformed(kind, &whole[..whole.len() - 1])?;
        }
        self.malformed(Kind::Status, &[])?;
        self.malformed(Kind::Reset, &[0; 4])?;
        for bit in FIRST_BIT..u8::BITS {
            let no_meaning = 1 << bit;
            self.malformed(Kind::Reset, &[no_meaning, 0, 0, 0, 0])?;
            // The span's table and bank.
            self.malformed(Kind::TableCrc, &[no_meaning, 0, 0, 0, 0, 0, 0])?;
            self.malformed(Kind::TableCrc, &[0, no_meaning, 0, 0, 0, 0, 0])?;
            if let Some(burst) = burst {
                let mut burst = payload(&Request::Burst(burst));
                burst.pop();
                burst.push(no_meaning);
                self.malformed(Kind::Burst, &burst)?;
            }
        }
        Ok(())
    }

    fn malformed(&mut self, kind: Kind, payload: &[u8]) -> Result<(), End> {
        self.bytes_refused(Rule::Payload, kind, payload, RefusalCode::Payload, 0)
    }
}

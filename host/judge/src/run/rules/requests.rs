//! Requests that no host makes: cut short, without meaning, out of range.

use halfrow_protocol::Kind;
use halfrow_protocol::message::{Burst, BurstMode, Commit, Configuration, RefusalCode, Request, Span};

use super::{FIRST_FACTOR, Rules, payload};
use crate::result::Rule;
use crate::run::findings::End;

/// In a byte that has few values it is none of them.
const NO_MEANING: u8 = 0x80;
/// The places of CONFIGURE's fields (WIRE.md, 18).
const WIDTH: u16 = 0;
const HEIGHT: u16 = 1;
const CENTRE: u16 = 2;
const BLANKING: u16 = 3;
const BITS: u16 = 5;

impl Rules<'_, '_> {
    pub(super) fn requests(&mut self) -> Result<(), End> {
        self.without_meaning()?;
        for kind in [Kind::RowOut, Kind::Refusal] {
            self.bytes_refused(Rule::Kind, kind, &[], RefusalCode::Kind, 0)?;
        }
        self.configurations()
    }

    /// Every request by a byte too short, and with a field that has no meaning.
    fn without_meaning(&mut self) -> Result<(), End> {
        let span = Span { count: 0, ..FIRST_FACTOR };
        let commit = Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: 1, shape: None };
        let burst = self.run.board.capabilities.bursts.map(|bursts| Burst {
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
        // The reset's level; the span's table and bank; the burst's mode.
        self.malformed(Kind::Reset, &[NO_MEANING, 0, 0, 0, 0])?;
        self.malformed(Kind::TableCrc, &[NO_MEANING, 0, 0, 0, 0, 0, 0])?;
        self.malformed(Kind::TableCrc, &[0, NO_MEANING, 0, 0, 0, 0, 0])?;
        if let Some(burst) = burst {
            let mut burst = payload(&Request::Burst(burst));
            burst.pop();
            burst.push(NO_MEANING);
            self.malformed(Kind::Burst, &burst)?;
        }
        Ok(())
    }

    fn malformed(&mut self, kind: Kind, payload: &[u8]) -> Result<(), End> {
        self.bytes_refused(Rule::Payload, kind, payload, RefusalCode::Payload, 0)
    }

    /// The small frames', with the least blanking.
    pub(super) fn configuration(&self) -> Configuration {
        let geometry = &self.small.geometry;
        Configuration {
            width: geometry.width() as u16,
            height: geometry.height() as u16,
            centre2: geometry.centre2() as u16,
            blanking: self.capabilities.least_blanking,
            gap_seed: 0,
            bits: geometry.depth().bits() as u8,
        }
    }

    /// Each field out of range, by each of the bits that make it so.
    fn configurations(&mut self) -> Result<(), End> {
        let right = self.configuration();
        let (width, height) = (self.capabilities.max_width, self.capabilities.max_height);
        let mut wrong = vec![
            (WIDTH, Configuration { width: right.width + 1, ..right }),
            (WIDTH, Configuration { width: right.width - 2, ..right }),
            (HEIGHT, Configuration { height: 0, ..right }),
            (CENTRE, Configuration { centre2: 2 * right.width - 1, ..right }),
            (BITS, Configuration { bits: right.bits + 1, width: 0, ..right }),
        ];
        for bit in (0..u16::BITS).map(|bit| 1_u16 << bit) {
            let beyond = |value: u16, most: u16| (value > most).then_some(value);
            let wide = beyond(right.width | bit, width).map(|width| Configuration { width, ..right });
            let tall = beyond(bit, height).map(|height| Configuration { height, ..right });
            let aside = beyond(bit, 2 * right.width - 2).map(|centre2| Configuration { centre2, ..right });
            wrong.extend(wide.map(|wide| (WIDTH, wide)));
            wrong.extend(tall.map(|tall| (HEIGHT, tall)));
            wrong.extend(aside.map(|aside| (CENTRE, aside)));
        }
        if let Some(blanking) = right.blanking.checked_sub(1) {
            wrong.push((BLANKING, Configuration { blanking, ..right }));
        }
        for (field, configuration) in wrong {
            let request = Request::Configure(configuration);
            self.refused(Rule::Configuration, &request, RefusalCode::Range, field)?;
        }
        Ok(())
    }
}

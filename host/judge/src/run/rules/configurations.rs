//! Configurations that must be refused and leave the present one as it was.

use halfrow_model::BitDepth;
use halfrow_protocol::Kind;
use halfrow_protocol::message::{BurstMode, Commit, Configuration, RefusalCode, Request};

use super::compared::Compared;
use super::rows::{FRAME, GENERATION};
use super::{Rules, payload};
use crate::result::Rule;
use crate::run::findings::End;

/// The numbers of CONFIGURE's fields (WIRE.md, 18).
const WIDTH: u16 = 0;
const HEIGHT: u16 = 1;
const CENTRE: u16 = 2;
const BLANKING: u16 = 3;
const BITS: u16 = 5;

impl Rules<'_, '_> {
    /// The configuration for small frames, with the least blanking.
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

    /// After many refused configurations, rows and frames are still those of the configuration before them.
    pub(super) fn configurations(&mut self) -> Result<(), End> {
        let gap_seed = !self.small.seed | 1;
        let right = Configuration { gap_seed, ..self.configuration() };
        self.replied(Rule::Configuration, &Request::Configure(right), Vec::new())?;
        let other = self.another(right);
        for (field, wrong) in self.out_of_range(other) {
            let request = Request::Configure(wrong);
            self.refused(Rule::Configuration, &request, RefusalCode::Range, field)?;
        }
        let other = payload(&Request::Configure(other));
        let short = &other[..other.len() - 1];
        self.bytes_refused(Rule::Configuration, Kind::Configure, short, RefusalCode::Payload, 0)?;
        // A board without a configuration would answer `not ready`, which comes first.
        let unnamed = Commit { steps_crc: 0, kernel_crc: 0, first_frame: 0, generation: 0, shape: None };
        self.refused(Rule::Configuration, &Request::Commit(unnamed), RefusalCode::Range, 0)?;
        self.right_burst(Rule::Configuration, BurstMode::Fresh)?;
        let made = self.small.made(0, self.height, GENERATION);
        // Two frames, since the gaps begin anew with each.
        let compared = Compared::with_gaps(gap_seed).with(&self.small, [FRAME, FRAME + 1], &made);
        self.frames(Rule::Configuration, compared)?;
        self.configure(self.height)
    }

    /// A right configuration that differs from `own` in every field, as far as the board allows.
    fn another(&self, own: Configuration) -> Configuration {
        let depths = self.capabilities.sample_depths();
        let others = BitDepth::ALL.map(|depth| depth.bits() as u8).into_iter();
        let bits = others.filter(|&bits| depths.has(bits)).find(|&bits| bits != own.bits);
        Configuration {
            width: (own.width + 2).min(self.capabilities.max_width),
            height: (own.height - 1).max(1),
            centre2: own.centre2 - 1,
            blanking: own.blanking.saturating_add(1),
            gap_seed: !own.gap_seed,
            bits: bits.unwrap_or(own.bits),
        }
    }

    /// `other` with each field out of range, once by each bit that makes it so.
    fn out_of_range(&self, other: Configuration) -> Vec<(u16, Configuration)> {
        let (width, height) = (self.capabilities.max_width, self.capabilities.max_height);
        let least = self.configuration();
        let mut wrong = vec![
            (WIDTH, Configuration { width: least.width + 1, ..other }),
            (WIDTH, Configuration { width: least.width - 2, ..other }),
            (HEIGHT, Configuration { height: 0, ..other }),
            (CENTRE, Configuration { centre2: 2 * other.width - 1, ..other }),
            (BITS, self.without_depth(other)),
        ];
        for bit in (0..u16::BITS).map(|bit| 1_u16 << bit) {
            let beyond = |value: u16, most: u16| (value > most).then_some(value);
            let wide = beyond(least.width | bit, width).map(|width| Configuration { width, ..other });
            let tall = beyond(bit, height).map(|height| Configuration { height, ..other });
            let aside = beyond(bit, 2 * other.width - 2).map(|centre2| Configuration { centre2, ..other });
            wrong.extend(wide.map(|wide| (WIDTH, wide)));
            wrong.extend(tall.map(|tall| (HEIGHT, tall)));
            wrong.extend(aside.map(|aside| (CENTRE, aside)));
        }
        if let Some(blanking) = least.blanking.checked_sub(1) {
            wrong.push((BLANKING, Configuration { blanking, ..other }));
        }
        wrong
    }

    /// `other` with a depth that no board has and a width of 0; the refusal must name the depth.
    pub(super) fn without_depth(&self, other: Configuration) -> Configuration {
        Configuration { bits: other.bits + 1, width: 0, ..other }
    }
}

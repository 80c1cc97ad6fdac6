//! Rows that a board corrected rightly, but made of another content than it must.
//!
//! A board that misreads AT-SPEED.md's "Content" is wrong in all rows of one kind, which looks like a path that fails at speed.

use halfrow_model::{Content, Frame, Phase, xorshift32};

use crate::reference::correct;
use crate::result::{Account, ContentKind, Defect, Evidence, MadeAs, Suspect};
use crate::run::at_speed::MadeRows;
use crate::tables::Generation;

/// The kinds by the lowest two bits of a row's first draw.
const KINDS: [ContentKind; 4] =
    [ContentKind::Noise, ContentKind::Swing, ContentKind::Toggle, ContentKind::Steps];
/// Bits of a seed that a board may keep of it.
const KEPT: [u32; 3] = [8, 16, 24];
/// One in so many draws that a board may take as the edge of a step.
const ONE_IN: [u32; 5] = [2, 4, 8, 32, 64];

/// What decides the samples of a row.
#[derive(Clone, Copy)]
struct Made {
    kind: ContentKind,
    /// p, and whether the first group is high, of a toggle.
    toggle: (u32, bool),
    one_in: u32,
    /// The first draw.
    draw: u32,
}

impl Made {
    /// Row `row` of `content`, as AT-SPEED.md says.
    fn of(Content { seed, frame }: Content, row: usize) -> Self {
        let draw = xorshift32((seed ^ (u32::from(frame) << 12 | row as u32)) | 1 << 31);
        let toggle = (draw >> 2 & 3, draw >> 4 & 1 == 1);
        Self { kind: KINDS[draw as usize % 4], toggle, one_in: 16, draw }
    }

    /// Samples up to `max`.
    fn samples(&self, width: usize, max: u16) -> Vec<u16> {
        let (mut draw, mut held) = (self.draw, None);
        let full = |high| if high { max } else { 0 };
        let sample = |column: usize| {
            draw = xorshift32(draw);
            let level = (draw >> 20) as u16 & max;
            let sample = match (self.kind, held) {
                (ContentKind::Noise, _) => level,
                (ContentKind::Swing, _) => full(draw >> 31 == 1),
                (ContentKind::Toggle, _) => {
                    let (p, is_high) = self.toggle;
                    full((column >> p) % 2 != usize::from(is_high))
                }
                (ContentKind::Steps, Some(held)) if !draw.is_multiple_of(self.one_in) => held,
                (ContentKind::Steps, _) => level,
            };
            held = Some(sample);
            sample
        };
        (0..width).map(sample).collect()
    }

    /// What a board may make of row `row` of `content` in its place.
    fn others(content: Content, row: usize) -> Vec<(MadeAs, Self)> {
        let own = Self::of(content, row);
        let of_kind = KINDS.map(|kind| (MadeAs::Kind { kind }, Self { kind, ..own }));
        let toggles = (0..4).flat_map(|p| [false, true].map(|is_high| (p, is_high)));
        let of_toggle =
            toggles.map(|toggle @ (p, high)| (MadeAs::Toggle { p, high }, Self { toggle, ..own }));
        let of_steps = ONE_IN.map(|one_in| (MadeAs::Steps { one_in }, Self { one_in, ..own }));
        let of_seed = KEPT.map(|bits| {
            let seed = content.seed & ((1 << bits) - 1);
            (MadeAs::SeedOf { bits }, Self::of(Content { seed, ..content }, row))
        });
        let of_frame = [-1_i16, 1].map(|frames| {
            let frame = content.frame.wrapping_add_signed(frames);
            (MadeAs::OtherFrame { frames }, Self::of(Content { frame, ..content }, row))
        });
        let of_row = [-1_isize, 1]
            .map(|rows| (MadeAs::OtherRow { rows }, Self::of(content, row.wrapping_add_signed(rows) % 4096)));
        let of_kind = of_kind.into_iter().filter(|(_, made)| made.kind != own.kind);
        let of_toggle = of_toggle.filter(|_| own.kind == ContentKind::Toggle);
        let of_steps = of_steps.into_iter().filter(|_| own.kind == ContentKind::Steps);
        of_toggle.chain(of_steps).chain(of_seed).chain(of_frame).chain(of_row).chain(of_kind).collect()
    }
}

/// The suspect, if the last row that was `seen` is exactly what its tables make of another content than that of `content`.
pub(super) fn content_wrong(seen: &MadeRows, content: Content, phase: Phase) -> Option<Suspect> {
    let MadeRows { made_by, evidence: Evidence { input, expected, found, .. } } = seen;
    let row = expected.height().checked_sub(1)?;
    let kind = Made::of(content, row).kind;
    let is_found = |made: &Made| {
        let samples = made.samples(input.width(), input.depth().max());
        corrected(made_by, input, &samples, phase).is_some_and(|made| made.row(row) == found.row(row))
    };
    let (made, _) = Made::others(content, row).into_iter().find(|(_, made)| is_found(made))?;
    let pairs = expected.row(row).iter().zip(found.row(row));
    let differing = pairs.filter(|(expected, found)| expected != found).count();
    let account =
        Account::Samples { differing, explained: differing, contradicted: 0, others: 0, set_in: false };
    Some(Suspect { defect: Defect::ContentWrong { row, kind, made }, account, explained: 1.0 })
}

/// `input` with `last` as its last row, as `made_by` corrects it.
fn corrected(made_by: &Generation, input: &Frame, last: &[u16], phase: Phase) -> Option<Frame> {
    let mut samples = input.samples().to_vec();
    let place = samples.len().checked_sub(last.len())?;
    samples[place..].copy_from_slice(last);
    let input = Frame::new(input.width(), input.depth(), phase, samples).ok()?;
    correct(&made_by.tables, &made_by.kernel, &input).ok()
}

#[cfg(test)]
mod tests {
    use halfrow_model::{BitDepth, Content};

    use super::*;

    /// The model and the page say what content is; the variants must begin at the same.
    #[test]
    fn what_others_are_compared_with_is_the_models_content() {
        for row in 0..64 {
            let content = Content { seed: 0x1234_5678, frame: 3 };
            let mut samples = [0; 64];
            content.row(row, BitDepth::Twelve, &mut samples);
            assert_eq!(Made::of(content, row).samples(64, 4095), samples, "row {row}");
        }
    }
}

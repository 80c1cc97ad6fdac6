//! What a recorded host sent: the frames, assembled from their rows. Of several rows under one number the first counts, since a
//! run streams its frames before anything else.

use std::collections::BTreeMap;

use halfrow_protocol::message::{Request, RowIn};
use halfrow_protocol::{Decoder, samples};

/// Rows and commits among recorded bytes.
#[derive(Debug, Default)]
pub(super) struct Sent {
    /// The first frame of each committed generation.
    pub(super) first_frames: BTreeMap<u8, u16>,
    rows: BTreeMap<(u16, u16), Vec<u16>>,
}

impl Sent {
    /// Finds them in all bytes that a host sent, given in `pieces`. Rows of frames that are not `wanted` are left out.
    #[must_use]
    pub(super) fn find<'a>(pieces: impl Iterator<Item = &'a [u8]>, wanted: impl Fn(u16) -> bool) -> Self {
        let mut sent = Self::default();
        let mut decoder = Decoder::new();
        for mut bytes in pieces {
            while let Some(packet) = decoder.next(&mut bytes) {
                let Ok(packet) = packet else { continue };
                match Request::read(&packet) {
                    Ok(Request::Commit(commit)) => {
                        sent.first_frames.entry(commit.generation).or_insert(commit.first_frame);
                    }
                    Ok(Request::RowIn(row)) if wanted(row.place.frame) => sent.keep(&row),
                    _ => {}
                }
            }
        }
        sent
    }

    fn keep(&mut self, row: &RowIn<'_>) {
        self.rows.entry((row.place.frame, row.place.row)).or_insert_with(|| {
            let mut unpacked = vec![0; usize::from(row.place.width)];
            samples::unpack(row.packed, &mut unpacked);
            unpacked
        });
    }

    /// The samples of frame `number`, `width` × `height`; rows that were never sent are black.
    #[must_use]
    pub(super) fn frame(&self, number: u16, width: usize, height: usize) -> Vec<u16> {
        let mut frame = vec![0; width * height];
        for ((_, row), samples) in self.rows.range((number, 0)..=(number, u16::MAX)) {
            if let Some(place) = frame.chunks_exact_mut(width).nth(usize::from(*row))
                && place.len() == samples.len()
            {
                place.copy_from_slice(samples);
            }
        }
        frame
    }
}

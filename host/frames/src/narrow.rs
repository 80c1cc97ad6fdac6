//! A word on frames whose samples fill little of their depth, which is seldom meant.

use std::sync::Once;

use halfrow_model::BitDepth;

/// Says once that raw samples of a file whose largest is `full` are dark in frames of `depth`, if they are.
pub(super) fn note(full: u16, depth: BitDepth) {
    static SAID: Once = Once::new();
    let max = depth.max();
    if full < max {
        SAID.call_once(|| {
            tracing::warn!(
                "samples of 0 to {full} are taken as they are, of 0 to {max}, and so are dark; name the bits if the \
                 frames have fewer bits, or scale them"
            );
        });
    }
}

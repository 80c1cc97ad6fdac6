//! A warning about frames whose samples use little of their depth, which is rarely intended.

use std::sync::Once;

use halfrow_model::BitDepth;

/// Warns, once per process, if raw samples from a file whose largest sample is `full` are dark in frames of `depth`.
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

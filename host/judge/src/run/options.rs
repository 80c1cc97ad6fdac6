//! How a run is made, whatever it judges.

use std::time::Duration;

use super::Circumstances;
use crate::board::Stop;
use crate::board::deadlines::RetryLimit;

/// How a run is made. The default is a patient one: no time limit, the usual share of retries, an end when the board goes
/// away, nobody cut off, any kind of board, which is asked what came to it.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The longest that the run may take on the link's clock. That of a mock or a recording is not a person's: [`Stop::wall_limit`] ends
    /// a run by this computer's.
    pub timeout: Option<Duration>,
    /// Who else can end it early.
    pub stop: Stop,
    /// Have the board say how many packets came to it wherever one may have been lost unseen ([`OpenOptions::counts`]). A recording
    /// that does not say so is of a run that did not.
    ///
    /// [`OpenOptions::counts`]: crate::board::OpenOptions::counts
    pub counts: bool,
    /// The retries that it may have.
    pub retry_limit: RetryLimit,
    /// How long a board that goes away may stay away; none if the run ends then. Needs a
    /// [`Reopener`](crate::link::Reopener).
    pub reconnect: Option<Duration>,
    /// Take the board from whoever holds it.
    pub take_over: bool,
    /// Refuse anything but hardware.
    pub require_hardware: bool,
    /// The most bytes of frames that are kept for diagnosis and pictures. Those that differ come first; how many found no
    /// place, the report says.
    pub evidence_bytes: usize,
    /// Give frames that are equal out, too, for pictures of them. The diagnosis has them in any case.
    pub keep_equal: bool,
    /// What the report says of the run beside its findings.
    pub circumstances: Circumstances,
}

impl RunOptions {
    /// The default of [`RunOptions::evidence_bytes`], 64 MiB: five frames of 1920 x 1080 with what went in and what should
    /// have come back.
    pub(crate) const EVIDENCE_BYTES: usize = 64 << 20;
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            timeout: None,
            stop: Stop::default(),
            counts: true,
            retry_limit: RetryLimit::default(),
            reconnect: None,
            take_over: false,
            require_hardware: false,
            evidence_bytes: Self::EVIDENCE_BYTES,
            keep_equal: false,
            circumstances: Circumstances::default(),
        }
    }
}

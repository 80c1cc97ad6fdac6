//! How a run is made, independent of what it judges.

use std::time::Duration;

use super::Provenance;
use crate::board::{RetryLimit, Stop};

/// How a run is made. By default it has no time limit and the usual retry limit, it ends when the board goes away, it does not
/// take the board from another host, it judges any kind of board, and it asks the board how many packets reached it.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The longest time that the run may take on the link's clock. For a mock or a recording this is not real time;
    /// [`Stop::wall_limit`] is a limit on this computer's clock.
    pub timeout: Option<Duration>,
    /// Other ways to end it early.
    pub stop: Stop,
    /// Ask the board how many packets reached it wherever one may have been lost unseen ([`OpenOptions::counts`]). A
    /// recording that does not have this setting is of a run that did not ask.
    ///
    /// [`OpenOptions::counts`]: crate::board::OpenOptions::counts
    pub counts: bool,
    /// The retries that the run may have.
    pub retry_limit: RetryLimit,
    /// How long a board that goes away may stay away; none if the run ends at once. Needs a
    /// [`Reopener`](crate::link::Reopener).
    pub reconnect: Option<Duration>,
    /// Take the board from whoever holds it.
    pub take_over: bool,
    /// Refuse anything but hardware.
    pub require_hardware: bool,
    /// The most bytes of frames that are kept for diagnosis and pictures. Frames that differ come first. The report says
    /// how many did not fit.
    pub evidence_bytes: usize,
    /// Also return frames that are equal, for pictures of them. The diagnosis has them in any case.
    pub keep_equal: bool,
    /// What the report says about the run besides its findings.
    pub provenance: Provenance,
}

impl RunOptions {
    /// The default of [`RunOptions::evidence_bytes`], 64 MiB: five frames of 1920 x 1080, each as it went in, as it came
    /// back and as it should have.
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
            provenance: Provenance::default(),
        }
    }
}

//! What the engine keeps of one lane.

use super::asked::Asked;
use super::hook_queue::HookQueue;
use super::known::KnownOfLane;
use super::lane_threads::StopAsked;
use crate::presence::Presence;

/// What only the engine's thread has of a lane.
pub(super) struct LaneWork {
    pub(super) presence: Presence,
    pub(super) stop: StopAsked,
    pub(super) asked: Asked,
    /// What is known of what it owes its shift.
    pub(super) known: KnownOfLane,
    /// The run that there was no thread to save.
    pub(super) unrecovered: Option<String>,
    pub(super) hooks: HookQueue,
}

impl LaneWork {
    /// A lane that nothing has happened to yet.
    pub(super) fn new() -> Self {
        Self {
            presence: Presence::default(),
            stop: StopAsked::default(),
            asked: Asked::default(),
            known: KnownOfLane::NOTHING,
            unrecovered: None,
            hooks: HookQueue::new(),
        }
    }
}

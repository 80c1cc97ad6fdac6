//! What distinguishes the states without colour: a shape and a word for each.

use maud::{Markup, html};

use crate::engine::LaneState;
use crate::floor::{Act, Shown, Word};
use crate::web::routes::Who;
use crate::web::visit::Visit;

/// The state in a word.
pub(super) fn said(visit: &Visit, word: Word) -> &'static str {
    match word {
        Word::Empty => visit.say("state.empty"),
        Word::Ready => visit.say("state.ready"),
        Word::Waiting => visit.say("state.waiting"),
        Word::Running => visit.say("state.running"),
        Word::Saving => visit.say("state.saving"),
        Word::Pass => visit.say("state.pass"),
        Word::Fail => visit.say("state.fail"),
        Word::Error => visit.say("state.error"),
        Word::Unsaved => visit.say("state.unsaved"),
        Word::Out => visit.say("state.out"),
    }
}

/// What the operator should do now. Where the reason itself asks for something, it is not said twice.
pub(super) fn does(visit: &Visit, state: &LaneState, is_asked: bool) -> Option<&'static str> {
    // While nobody is logged in, scans are badges.
    let is_barred = visit.can_log_in && !visit.may(Who::Operator);
    // A badge is refused while it is not known who may.
    let badge = visit.untold.is_none().then(|| visit.say("does.badge"));
    Some(match state.state {
        Word::Out if is_asked => return None,
        Word::Error if is_asked => visit.say("does.unjudged"),
        Word::Ready if is_barred => return badge,
        Word::Waiting if is_barred && state.can.contains(&Act::Start) => return badge,
        Word::Empty => visit.say("does.empty"),
        Word::Ready => visit.say("does.ready"),
        Word::Waiting if state.can.contains(&Act::Start) => visit.say("does.start"),
        // This lane is started by plugging the board in.
        Word::Waiting if state.is_present => visit.say("does.again"),
        Word::Waiting => visit.say("does.plug"),
        Word::Running => visit.say("does.running"),
        Word::Saving => visit.say("does.saving"),
        Word::Pass | Word::Fail if is_of_no_hardware(state) => visit.say("does.simulated"),
        Word::Pass => visit.say("does.pass"),
        Word::Fail => visit.say("does.fail"),
        Word::Error => visit.say("does.error"),
        Word::Unsaved => visit.say("does.unsaved"),
        Word::Out => visit.say("does.out"),
    })
}

/// Whether the verdict is on a board that a program plays.
fn is_of_no_hardware(state: &LaneState) -> bool {
    state.shown.as_ref().is_some_and(Shown::is_of_no_hardware)
}

/// The state's shape.
pub(super) fn shape(word: Word) -> Markup {
    html! {
        svg.shape viewBox="0 0 24 24" aria-hidden="true" { path fill-rule="evenodd" d=(path(word)) {} }
    }
}

/// The outline, in a square of 24 by 24.
fn path(word: Word) -> &'static str {
    match word {
        Word::Empty => "M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18zm0 3a6 6 0 1 1 0 12a6 6 0 1 1 0-12z",
        Word::Ready => "M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18z",
        Word::Waiting => "M5 2h14v5l-5 5l5 5v5H5v-5l5-5l-5-5zm3 3v1l4 4l4-4V5z",
        Word::Running => "M5 2l16 10L5 22z",
        Word::Saving => "M2 10h4.500v4.500H2zm7.700 0h4.500v4.500H9.700zm7.800 0H22v4.500h-4.500z",
        Word::Pass => "M2 13l3.500-3.500L10 14L19 4l3 3L10 20z",
        Word::Fail => "M3 6l3-3l6 6l6-6l3 3l-6 6l6 6l-3 3l-6-6l-6 6l-3-3l6-6z",
        Word::Error => "M12 1l11.500 21H.5zm-1.500 7l.5 7h2l.5-7zm.2 9v3h2.600v-3z",
        Word::Unsaved => "M7 1h10l6 6v10l-6 6H7l-6-6V7zM5 10v4h14v-4z",
        Word::Out => "M3 10h18v4H3z",
    }
}

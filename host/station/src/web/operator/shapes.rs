//! What tells the states apart without colour: a shape and a word each.

use maud::{Markup, html};

use crate::floor::Word;

/// How a state is shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Its class in the style sheet.
    pub(super) class: &'static str,
    /// The key of its word.
    pub(super) key: &'static str,
    /// The key of what the operator does now.
    pub(super) does: &'static str,
    /// Its shape in a square of 24.
    shape: &'static str,
}

/// How `word` is shown.
pub(super) fn look(word: Word) -> Look {
    let (class, word, does, shape) = match word {
        Word::Empty => (
            "empty",
            Said { key: "state.empty" },
            Said { key: "does.empty" },
            "M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18zm0 3a6 6 0 1 1 0 12a6 6 0 1 1 0-12z",
        ),
        Word::Ready => (
            "ready",
            Said { key: "state.ready" },
            Said { key: "does.ready" },
            "M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18z",
        ),
        Word::Waiting => (
            "waiting",
            Said { key: "state.waiting" },
            Said { key: "does.waiting" },
            "M5 2h14v5l-5 5l5 5v5H5v-5l5-5l-5-5zm3 3v1l4 4l4-4V5z",
        ),
        Word::Running => {
            ("running", Said { key: "state.running" }, Said { key: "does.running" }, "M5 2l16 10L5 22z")
        }
        Word::Saving => (
            "saving",
            Said { key: "state.saving" },
            Said { key: "does.saving" },
            "M2 10h4.500v4.500H2zm7.700 0h4.500v4.500H9.700zm7.800 0H22v4.500h-4.500z",
        ),
        Word::Pass => (
            "pass",
            Said { key: "state.pass" },
            Said { key: "does.pass" },
            "M2 13l3.500-3.500L10 14L19 4l3 3L10 20z",
        ),
        Word::Fail => (
            "fail",
            Said { key: "state.fail" },
            Said { key: "does.fail" },
            "M3 6l3-3l6 6l6-6l3 3l-6 6l6 6l-3 3l-6-6l-6 6l-3-3l6-6z",
        ),
        Word::Error => (
            "error",
            Said { key: "state.error" },
            Said { key: "does.error" },
            "M12 1l11.500 21H.5zm-1.500 7l.5 7h2l.5-7zm.2 9v3h2.600v-3z",
        ),
        Word::Unsaved => (
            "unsaved",
            Said { key: "state.unsaved" },
            Said { key: "does.unsaved" },
            "M7 1h10l6 6v10l-6 6H7l-6-6V7zM5 10v4h14v-4z",
        ),
        Word::Out => ("out", Said { key: "state.out" }, Said { key: "does.out" }, "M3 10h18v4H3z"),
    };
    Look { class, key: word.key, does: does.key, shape }
}

struct Said {
    key: &'static str,
}

impl Look {
    /// Its shape.
    pub(super) fn shape(&self) -> Markup {
        html! {
            svg.shape viewBox="0 0 24 24" aria-hidden="true" { path fill-rule="evenodd" d=(self.shape) {} }
        }
    }
}

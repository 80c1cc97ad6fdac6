//! What exhibits come to: the page takes its word from it, the program its exit code.

use halfrow::exit::Exit;

use super::Exhibit;

/// What several exhibits come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Everything was tried, and every number is accepted.
    Accepted,
    /// Every number is accepted, but something could not be tried.
    InPart,
    /// Of no item could everything be tried.
    NothingTried,
    /// A number is not accepted, by a fault of the reproduction.
    Missed,
    /// A number is not accepted, by the board's fault.
    BoardDiffers,
}

impl Outcome {
    /// What `exhibits` come to. A fault of the board weighs more than a number that could not be reproduced.
    #[must_use]
    pub fn of(exhibits: &[Exhibit]) -> Self {
        let missed = || exhibits.iter().flat_map(|exhibit| &exhibit.claims).filter(|claim| !claim.holds());
        let is_open = |exhibit: &Exhibit| !exhibit.open.is_empty();
        if missed().any(|claim| claim.judges_board) {
            Self::BoardDiffers
        } else if missed().next().is_some() {
            Self::Missed
        } else if !exhibits.iter().any(is_open) {
            Self::Accepted
        } else if exhibits.iter().all(is_open) {
            Self::NothingTried
        } else {
            Self::InPart
        }
    }

    /// The exit code of a program that shows the exhibits.
    #[must_use]
    pub fn exit(self) -> Exit {
        match self {
            Self::Accepted | Self::InPart => Exit::Pass,
            Self::NothingTried => Exit::NothingJudged,
            Self::Missed => Exit::Error,
            Self::BoardDiffers => Exit::Fail,
        }
    }

    /// The word over the page. `has_numbers` says whether any number was held to the paper.
    pub(super) fn word(self, has_numbers: bool) -> &'static str {
        match (self, has_numbers) {
            (Self::Accepted, true) => "REPRODUCED",
            (Self::Accepted, false) => "DRAWN",
            (Self::InPart, true) => "REPRODUCED IN PART",
            (Self::InPart, false) => "DRAWN IN PART",
            (Self::NothingTried, _) => "NOTHING TRIED",
            (Self::Missed, _) => "NOT REPRODUCED",
            (Self::BoardDiffers, _) => "BOARD DIFFERS",
        }
    }

    /// The class of the page's head, which says its colour. It is not green while something was not tried.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Accepted => "pass",
            Self::InPart | Self::NothingTried | Self::Missed => "error",
            Self::BoardDiffers => "fail",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::{Accepted, Claim, Item, page};

    fn drawn() -> Exhibit {
        Exhibit::new(Item::Fig8)
    }

    fn untried() -> Exhibit {
        Exhibit { open: vec!["there is no synthesis report".to_owned()], ..Exhibit::new(Item::Resources) }
    }

    fn found(found: f64, judges_board: bool) -> Exhibit {
        let accepted = Accepted::UpTo(1.0);
        let claim = Claim { what: String::new(), unit: "", paper: None, found, accepted, judges_board };
        Exhibit { claims: vec![claim], ..Exhibit::new(Item::Delay) }
    }

    /// As `halfrow help paper` describes the exit codes.
    #[test]
    fn page_and_exit_code_say_the_same() {
        for (exhibits, exit, word, class) in [
            (vec![drawn()], Exit::Pass, "DRAWN", "pass"),
            (vec![drawn(), untried()], Exit::Pass, "DRAWN IN PART", "error"),
            (vec![found(1.0, true)], Exit::Pass, "REPRODUCED", "pass"),
            (vec![found(1.0, true), untried()], Exit::Pass, "REPRODUCED IN PART", "error"),
            (vec![untried()], Exit::NothingJudged, "NOTHING TRIED", "error"),
            (vec![found(2.0, false), untried()], Exit::Error, "NOT REPRODUCED", "error"),
            (vec![found(2.0, false), found(2.0, true)], Exit::Fail, "BOARD DIFFERS", "fail"),
        ] {
            assert_eq!(Outcome::of(&exhibits).exit(), exit, "{word}");
            let page = page::render(&exhibits).unwrap();
            let head = format!("<header class=\"{class}\"><p class=\"verdict\">{word}</p>");
            assert!(page.contains(&head), "{word}: {page}");
        }
    }
}

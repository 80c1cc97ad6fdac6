//! Each rule is seen broken: those that no other test breaks, by one board each.

use halfrow::board::RefusalCode;
use halfrow::result::{Finding, Rule};
use halfrow::verdict::Verdict;
use halfrow_protocol::message::{BurstMode, BurstState, Records, ResetLevel, RowOut, Status};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Passing, Toward};

use super::by_the_rules::{altering, carried_out, refusal};

/// What a board does to packets, either way.
type Misconduct = Box<dyn FnMut(Toward, Passing) -> Vec<Passing> + Send>;

/// What a board does that breaks `rule` and none that is tried before it; none if another test has such a board.
fn breaking(rule: Rule) -> Option<Misconduct> {
    match rule {
        Rule::Span => Some(carrying_out(Kind::TableRead, RefusalCode::Range)),
        Rule::Generation => Some(carrying_out(Kind::Commit, RefusalCode::Range)),
        Rule::Pending => Some(carrying_out(Kind::Commit, RefusalCode::Busy)),
        Rule::Forgotten => Some(naming_the_last_commit()),
        Rule::Wide => Some(spoiling_wide_rows()),
        Rule::RowNumber => Some(losing_the_highest_bit()),
        Rule::Burst => Some(carrying_out(Kind::Burst, RefusalCode::Range)),
        Rule::Cut => Some(never_cut()),
        Rule::Repeated => Some(never_repeating()),
        Rule::PowerUp => Some(keeping_tables()),
        // In unkept_rules.rs.
        Rule::Kind | Rule::Unanswered | Rule::NewSession | Rule::RefusalSession | Rule::Shape => None,
        Rule::NoGrid | Rule::Window | Rule::Credit | Rule::NotReady => None,
        // In rule_by_rule.rs and rules.rs.
        Rule::Payload | Rule::Skipped | Rule::Configuration | Rule::Entry | Rule::Address => None,
        Rule::CommitCrc | Rule::Inside | Rule::Rows | Rule::Samples | Rule::Again => None,
        Rule::UnderWay | Rule::Records | Rule::Ended | Rule::Trap => None,
        // In answered_twice.rs, session_rules.rs, seldom_asked.rs and kept_rows.rs; and a scenario of any-session.
        Rule::Damage | Rule::Once | Rule::Held | Rule::Closed | Rule::RowPlace | Rule::CommitFrame => None,
        Rule::Banks | Rule::Session => None,
    }
}

/// It takes requests of `kind` that it must refuse with `code`.
fn carrying_out(kind: Kind, code: RefusalCode) -> Misconduct {
    saying(move |packet| {
        let refused = refusal(packet).filter(|refusal| refusal.kind == kind.code() && refusal.code == code);
        refused.map(|refusal| carried_out(packet, refusal))
    })
}

/// It says something else where `other` has something.
fn saying(mut other: impl FnMut(&Passing) -> Option<Passing> + Send + 'static) -> Misconduct {
    Box::new(move |toward, packet| {
        let other = if toward == Toward::Host { other(&packet) } else { None };
        vec![other.unwrap_or(packet)]
    })
}

/// Rows of the frame for which the rules commit tables have those of the last commit, it says, also behind a RESET that dropped it.
fn naming_the_last_commit() -> Misconduct {
    let mut last = None;
    saying(move |packet| match packet.reply()? {
        Reply::Commit { generation } => {
            last = Some(generation);
            None
        }
        Reply::RowOut(row) if row.place.frame == 0x5a5a => {
            Some(packet.saying(&Reply::RowOut(RowOut { generation: last?, ..row })))
        }
        _ => None,
    })
}

fn spoiling_wide_rows() -> Misconduct {
    saying(|packet| match packet.reply()? {
        Reply::RowOut(row) if row.place.width == 2048 => Some(packet.with_row(|_, packed| packed[3] ^= 4)),
        _ => None,
    })
}

fn losing_the_highest_bit() -> Misconduct {
    saying(|packet| match packet.reply()? {
        Reply::Status(status) => {
            let next_row_in = status.next_row_in & !(1 << 31);
            Some(packet.saying(&Reply::Status(Status { next_row_in, ..status })))
        }
        _ => None,
    })
}

/// A burst without an end is under way, it says, until the next one begins, whatever RESET came between.
fn never_cut() -> Misconduct {
    let (mut is_endless, mut is_cut) = (false, false);
    Box::new(move |toward, packet| {
        if toward == Toward::Board && packet.is(Kind::Burst) {
            // The number of frames (AT-SPEED.md, *Burst*).
            (is_endless, is_cut) = (packet.payload.get(4..8) == Some(&[u8::MAX; 4]), false);
        } else if toward == Toward::Board && packet.is(Kind::Reset) {
            is_cut = is_endless;
        } else if let Some(Reply::Records(records)) = packet.reply().filter(|_| is_cut) {
            let state = BurstState::UnderWay;
            return vec![packet.saying(&Reply::Records(Records { state, ..records }))];
        }
        vec![packet]
    })
}

fn never_repeating() -> Misconduct {
    Box::new(|toward, mut packet| {
        if toward == Toward::Board
            && packet.is(Kind::Burst)
            && let Some(mode) = packet.payload.get_mut(16).filter(|mode| **mode == BurstMode::Repeating as u8)
        {
            *mode = BurstMode::Fresh as u8;
        }
        vec![packet]
    })
}

/// Tables have other sums than at power-up, until they are written.
fn keeping_tables() -> Misconduct {
    let mut is_dropped = false;
    Box::new(move |toward, packet| {
        if toward == Toward::Board {
            let drops = packet.is(Kind::Reset) && packet.payload.first() == Some(&(ResetLevel::Tables as u8));
            is_dropped = drops || is_dropped && !packet.is(Kind::TableWrite);
        } else if let Some(Reply::TableCrc(crc)) = packet.reply().filter(|_| is_dropped) {
            return vec![packet.saying(&Reply::TableCrc(!crc))];
        }
        vec![packet]
    })
}

#[test]
fn each_rule_is_seen_broken() {
    for &rule in Rule::ALL {
        if let Some(misconduct) = breaking(rule) {
            let report = altering(misconduct);
            let found = match &report.finding {
                Finding::RuleBroken { rule, .. } => Some(*rule),
                Finding::CounterWrong { rule, .. } => *rule,
                _ => None,
            };
            assert_eq!((report.verdict(), found), (Verdict::Fail, Some(rule)), "{}", report.headline());
        }
    }
}

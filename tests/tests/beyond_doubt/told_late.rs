//! What a board does over rows that no link can do is its own fault whenever that comes, and whatever else goes wrong.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use halfrow::link::Candidate;
use halfrow::result::{CheckName, Finding};
use halfrow::run::Vary;
use halfrow::verdict::Verdict;
use halfrow_mock::Options;
use halfrow_protocol::message::{Bank, ResetLevel, RowOut, RowPlace};
use halfrow_protocol::{Kind, Reply, Request};
use halfrow_tests::altered::{Altered, Passing, Toward, judge, judge_each};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, failed_check, judge_by_plan, judge_reconnecting, open, streamed};

use crate::conduct::{fails, passes};
use crate::stale_packets::cut_when_told;

/// Frames beyond it are those by which rules are tried.
const PLANNED: u16 = 1000;
/// Of a row that comes twice.
const DIFFERS: &str = "came twice, and the copies differ in samples";

fn place(packet: &Passing) -> Option<RowPlace> {
    match packet.reply() {
        Some(Reply::RowOut(row)) => Some(row.place),
        _ => None,
    }
}

/// A row once more, under the next number, said to have been sent before, with another sample.
fn another(packet: &Passing) -> Passing {
    let other = packet.with_row(|row, packed| {
        packed[0] ^= 1;
        row.repeats = 1;
    });
    other.numbered(packet.header.sequence.wrapping_add(1))
}

#[test]
fn a_row_that_differs_behind_all_frames_is_the_board_s_fault() {
    let plan = streamed(System::TINY.plan());
    let sound = judge_by_plan(&plan, open("mock"));
    passes(&sound);
    let rows: usize = sound.frames.iter().map(|frame| frame.rows).sum();
    let (mut came, mut last) = (0, None);
    let alter = move |toward, packet: Passing| {
        if place(&packet).is_some() {
            came += 1;
            last = (came == rows).then(|| packet.clone());
        }
        let is_read_back = toward == Toward::Host && packet.is(Kind::TableCrc);
        let late = last.take_if(|_| is_read_back).map(|row| another(&row));
        late.into_iter().chain([packet]).collect()
    };
    let report = judge_by_plan(&plan, Altered::new(&Options::default(), alter).candidate());
    fails(&report, CheckName::Frames, DIFFERS);
}

#[test]
fn a_row_that_differs_is_the_board_s_fault_although_another_row_is_lost() {
    let report = judge(&System::TINY, |_, mut packet| match place(&packet) {
        Some(at) if at.row == 5 => Vec::new(),
        Some(at) if at.row == 3 && at.frame == 0 => vec![packet.clone(), another(&packet)],
        Some(at) if at.row > 3 && at.frame == 0 => {
            packet.header.sequence += 1;
            vec![packet]
        }
        _ => vec![packet],
    });
    fails(&report, CheckName::Frames, DIFFERS);
}

/// It breaks where the second frame is to be set, and the board that comes back is sound.
#[test]
fn what_a_board_did_is_not_forgotten_when_the_link_breaks_behind_it() {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut settings) = (Arc::clone(&is_cut), 0);
    let alter = move |toward, packet: Passing| {
        settings += usize::from(toward == Toward::Board && packet.is(Kind::Configure));
        cut.store(settings > 1, Ordering::Relaxed);
        match place(&packet) {
            Some(at) if at.last => vec![packet.clone(), another(&packet)],
            _ => vec![packet],
        }
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let candidate = Candidate {
        link: cut_when_told(candidate.link, is_cut),
        reopen: Some(Box::new(|| Ok(open("mock").link))),
        ..candidate
    };
    let report = judge_reconnecting(&System::TINY.plan(), Some(LIMIT), candidate);
    fails(&report, CheckName::Frames, DIFFERS);
}

/// In the session that is opened behind the one that the rules close, in which no row is sent.
#[test]
fn a_row_that_comes_behind_all_rules_is_the_board_s_fault() {
    let (mut row, mut is_closed, mut is_last) = (None, false, false);
    let report = judge(&System::TINY, move |toward, packet| {
        if place(&packet).is_some_and(|at| at.frame > PLANNED) {
            row = Some(packet.clone());
        }
        if let (Toward::Board, Some(Request::Reset(reset)), true) = (toward, packet.request(), row.is_some())
        {
            is_last |= is_closed && reset.level == ResetLevel::Tables;
            is_closed |= reset.level == ResetLevel::Session;
        }
        let is_count = toward == Toward::Host && packet.is(Kind::Status);
        let late = row.take_if(|_| is_last && is_count).map(|mut row| {
            row.header.session = packet.header.session;
            row
        });
        late.into_iter().chain([packet]).collect()
    });
    fails(&report, CheckName::Rules, "which it was never given");
}

/// Though every sample is right.
#[test]
fn rows_must_name_the_tables_that_made_them() {
    let report = judge_each(&System::TINY, |_, packet| match packet.reply() {
        Some(Reply::RowOut(row)) if row.place.frame == 2 && row.place.row == 5 => {
            packet.saying(&Reply::RowOut(RowOut { generation: row.generation + 1, ..row }))
        }
        _ => packet,
    });
    assert_eq!((report.verdict(), failed_check(&report)), (Verdict::Fail, Some(CheckName::Frames)));
    assert_eq!(report.finding, Finding::GenerationWrong { row: 5, frame: 2, named: 3, committed: 2 });
}

/// Beside frame 0x1234, whose rows are compared with their copies as well.
#[test]
fn rows_of_rules_must_name_the_tables_that_made_them() {
    let report = judge_each(&System::TINY, |_, packet| match packet.reply() {
        Some(Reply::RowOut(row)) if row.place.frame > PLANNED && row.place.frame != 0x1234 => {
            packet.saying(&Reply::RowOut(RowOut { generation: !row.generation, ..row }))
        }
        _ => packet,
    });
    assert_eq!((report.verdict(), failed_check(&report)), (Verdict::Fail, Some(CheckName::Rules)));
}

/// Before each of three frames that have another centre or depth, for which tables are replaced, and behind the last: by the port of
/// the row factors and by both of the kernel. `conduct` has a board that answers any of these wrongly.
#[test]
fn tables_in_use_are_read_back_before_they_are_replaced_and_at_the_end() {
    let plan = System { height: 16, ..System::TINY }.plan().varying(Vary { centre: true, depth: true });
    let plan = streamed(plan);
    let asked = Arc::new(AtomicUsize::new(0));
    let seen = Arc::clone(&asked);
    let count = move |toward, packet: Passing| {
        if let (Toward::Board, Some(Request::TableCrc(span))) = (toward, packet.request()) {
            seen.fetch_add(usize::from(span.bank == Bank::Active), Ordering::Relaxed);
        }
        vec![packet]
    };
    passes(&judge_by_plan(&plan, Altered::new(&Options::default(), count).candidate()));
    assert_eq!(asked.load(Ordering::Relaxed), (3 + 1) * (1 + 2));
}

//! Links that break after something wrong that may be the link's fault: it is judged again when the board comes back, and
//! reported when it does not.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use halfrow::link::{Candidate, Link, LinkError, Reopener};
use halfrow::progress::Silent;
use halfrow::result::{CheckName, Finding, Outcome, Report, SoakLength};
use halfrow::run::{AtSpeed, Plan, RunOptions, Vary, verify};
use halfrow::verdict::{Cause, Verdict};
use halfrow_mock::Options;
use halfrow_protocol::message::{Capabilities, Records, Welcome};
use halfrow_protocol::{Kind, Reply};
use halfrow_tests::altered::{Altered, Passing, Toward};
use halfrow_tests::patience::LIMIT;
use halfrow_tests::system::{System, judge_reconnecting, open, streamed};
use halfrow_tests::through::Through;

use crate::stale_packets::cut_when_told;

/// When a board is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// In every row, always.
    Always,
    /// In every row until the outage.
    Once,
}

/// The packet with a wrong bit, if it is a row that comes back.
fn spoilt(packet: &Passing) -> Passing {
    packet.with_row(|_, packed| packed[0] ^= 1)
}

/// A link to a board that is just switched on; if `wrong`, its rows are spoilt.
pub(crate) fn board(wrong: bool) -> Box<dyn Link> {
    let alter = move |_, packet: Passing| vec![if wrong { spoilt(&packet) } else { packet }];
    Altered::new(&Options::default(), alter).candidate().link
}

/// A board with packets that `alter` rewrites, over a link that can be cut.
pub(crate) fn breakable(
    alter: impl FnMut(Toward, Passing) -> Vec<Passing> + Send + 'static,
    is_cut: Arc<AtomicBool>,
) -> Candidate {
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let link = cut_when_told(candidate.link, is_cut);
    Candidate { link, ..candidate }
}

/// The report on such a board over a link that delivers the first CONFIGURE twice and breaks at the greeting of the next session.
/// If the run waits with `reconnect`, the board comes back.
fn unplugged_in_front_of_the_second_look(wrong: Wrong, reconnect: Option<Duration>) -> Report {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut greetings, mut configured) = (Arc::clone(&is_cut), 0, false);
    let alter = move |toward, packet: Passing| {
        if toward == Toward::Host {
            return vec![spoilt(&packet)];
        }
        greetings += usize::from(packet.is(Kind::Hello));
        cut.store(greetings > 1, Ordering::Relaxed);
        let is_first = packet.is(Kind::Configure) && !std::mem::replace(&mut configured, true);
        let twice = is_first.then(|| packet.clone());
        twice.into_iter().chain([packet]).collect()
    };
    let candidate = breakable(alter, is_cut);
    let back = move || Ok::<_, std::io::Error>(board(wrong == Wrong::Always));
    let candidate = Candidate { reopen: Some(Box::new(move || back().map_err(Into::into))), ..candidate };
    judge_reconnecting(&System::TINY.plan(), reconnect, candidate)
}

#[test]
fn a_board_that_comes_back_in_front_of_a_second_look_is_looked_at_again() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, Some(LIMIT));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
    let report = unplugged_in_front_of_the_second_look(Wrong::Once, Some(LIMIT));
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
}

#[test]
fn what_was_found_is_told_although_the_link_broke_in_front_of_the_second_look() {
    let report = unplugged_in_front_of_the_second_look(Wrong::Always, None);
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(broken_off.found, Finding::SamplesDiffer { .. }), "{}", report.headline());
    assert_eq!(broken_off.reason.code(), "link-broke");
    assert!(report.headline().contains("samples differ"), "{}", report.headline());
    assert!(report.remedy().is_some_and(|remedy| remedy.contains("cable")), "{:?}", report.remedy());
    let failed = report.checks.iter().filter(|check| check.outcome == Outcome::Failed);
    assert_eq!(failed.map(|check| check.name).collect::<Vec<CheckName>>(), []);
}

/// The report on a board whose rows are spoilt, over a link that breaks once the fifth row of the first frame has left the board.
/// If the run waits with `reconnect`, the board comes back.
fn unplugged_in_the_middle_of_a_frame(wrong: Wrong, reconnect: Option<Duration>) -> Report {
    let back = move || Ok(board(wrong == Wrong::Always));
    unplugged_behind_the_fifth_row(spoilt, Some(Box::new(back)), reconnect)
}

/// The same on a board whose rows are as `spoil` makes them, and that is opened again by `reopen`.
fn unplugged_behind_the_fifth_row(
    spoil: fn(&Passing) -> Passing,
    reopen: Option<Reopener>,
    reconnect: Option<Duration>,
) -> Report {
    let is_cut = Arc::new(AtomicBool::new(false));
    let cut = Arc::clone(&is_cut);
    let alter = move |_, packet: Passing| {
        let is_fifth = matches!(packet.reply(), Some(Reply::RowOut(row)) if row.place.row == 4);
        cut.fetch_or(is_fifth, Ordering::Relaxed);
        vec![spoil(&packet)]
    };
    let candidate = Candidate { reopen, ..breakable(alter, is_cut) };
    judge_reconnecting(&System::TINY.plan(), reconnect, candidate)
}

/// Beside its samples.
#[test]
fn what_rows_said_of_themselves_before_a_link_broke_counts_in_a_session_that_is_whole_alone() {
    let spoils: [fn(&Passing) -> Passing; 4] = [
        |packet| packet.with_row(|row, _| row.generation ^= 3),
        |packet| packet.with_row(|row, _| row.first_latency += 1),
        |packet| packet.with_row(|row, _| row.pauses += 1),
        |packet| packet.with_row(|row, _| row.entered = row.entered.map(|crc| crc ^ 1)),
    ];
    for spoil in spoils {
        let report = unplugged_behind_the_fifth_row(spoil, Some(Box::new(|| Ok(board(false)))), Some(LIMIT));
        assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
        assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    }
}

/// Each answer to a read-back in turn: behind it the link breaks, and the board that comes back is sound.
#[test]
fn tables_that_read_back_wrong_over_a_link_that_breaks_are_looked_at_again() {
    let plan = System { height: 16, ..System::TINY }.plan().varying(Vary { centre: true, depth: true });
    let plan = streamed(plan);
    let judged = |which: usize| {
        let is_cut = Arc::new(AtomicBool::new(false));
        let (cut, answers) = (Arc::clone(&is_cut), Arc::new(AtomicUsize::new(0)));
        let seen = Arc::clone(&answers);
        let alter = move |toward, packet: Passing| match packet.reply() {
            Some(Reply::TableCrc(crc))
                if toward == Toward::Host && seen.fetch_add(1, Ordering::Relaxed) == which =>
            {
                cut.store(true, Ordering::Relaxed);
                vec![packet.saying(&Reply::TableCrc(crc ^ 1))]
            }
            _ => vec![packet],
        };
        let reopen: Option<Reopener> = Some(Box::new(|| Ok(board(false))));
        let candidate = Candidate { reopen, ..breakable(alter, is_cut) };
        let report = judge_reconnecting(&plan, Some(LIMIT), candidate);
        (report, answers.load(Ordering::Relaxed))
    };
    let (_, answers) = judged(usize::MAX);
    assert!(answers > 10, "{answers}");
    for which in 0..answers {
        let (report, _) = judged(which);
        assert_eq!(report.verdict(), Verdict::Error, "answer {which} of {answers}: {}", report.headline());
    }
}

/// The rows are not judged again when their frame is sent once more.
#[test]
fn rows_of_a_frame_that_the_link_broke_in_count_in_a_session_that_is_whole_alone() {
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Once, Some(LIMIT));
    assert!(matches!(report.finding, Finding::RightInAnotherSession { .. }), "{}", report.headline());
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Always, Some(LIMIT));
    assert_eq!(report.verdict(), Verdict::Fail, "{}", report.headline());
}

#[test]
fn what_differed_in_a_frame_that_the_link_broke_in_is_in_the_report() {
    let report = unplugged_in_the_middle_of_a_frame(Wrong::Always, None);
    assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
    let [frame] = &report.frames[..] else { panic!("{:?}", report.frames) };
    assert!((1..8).contains(&frame.rows) && frame.comparison.differences > 0, "{frame:?}");
    assert_eq!((report.evidence.kept, report.evidence.left_out), (1, 0));
}

/// BURST comes twice, a frame has another signature, and the link breaks at the greeting of the session in which the frame is
/// made again.
#[test]
fn a_soak_that_breaks_off_in_front_of_a_second_look_tells_what_differed() {
    let is_cut = Arc::new(AtomicBool::new(false));
    let (cut, mut greetings) = (Arc::clone(&is_cut), 0);
    let alter = move |toward, mut packet: Passing| {
        greetings += usize::from(toward == Toward::Board && packet.is(Kind::Hello));
        cut.store(greetings > 1, Ordering::Relaxed);
        if toward == Toward::Host && packet.is(Kind::Records) {
            packet.payload.get_mut(Records::HEAD).into_iter().for_each(|byte| *byte ^= 1);
        }
        let twice = (toward == Toward::Board && packet.is(Kind::Burst)).then(|| packet.clone());
        twice.into_iter().chain([packet]).collect()
    };
    let at_speed = AtSpeed::Soak(SoakLength::Frames { frames: 3 });
    let plan = Plan { at_speed, fail_fast: false, ..System::TINY.plan() };
    let report = verify(&plan, breakable(alter, is_cut), &RunOptions::default(), &Silent).unwrap().report;
    assert_eq!((report.verdict(), report.cause), (Verdict::Error, Cause::Station), "{}", report.headline());
    let Finding::SecondLookBrokenOff(broken_off) = &report.finding else { panic!("{}", report.headline()) };
    assert!(matches!(broken_off.found, Finding::DiffersAtSpeed { .. }), "{}", report.headline());
    assert_eq!(broken_off.reason.code(), "link-broke");
}

/// The report on a sound board that is unplugged, in whose place another one comes, which says what `change` makes of what it says.
fn exchanged_for(change: fn(&Passing) -> Passing) -> Report {
    let back = move || {
        Ok(Altered::new(&Options::default(), move |_, packet| vec![change(&packet)]).candidate().link)
    };
    unplugged_behind_the_fifth_row(Passing::clone, Some(Box::new(back)), Some(LIMIT))
}

#[test]
fn a_board_of_another_number_build_or_capability_is_another_board() {
    assert_eq!(exchanged_for(Passing::clone).verdict(), Verdict::Pass);
    let others: [fn(&Passing) -> Passing; 3] = [
        |packet| match packet.reply() {
            Some(Reply::Hello(welcome)) => {
                packet.saying(&Reply::Hello(Welcome { serial: !welcome.serial, ..welcome }))
            }
            _ => packet.clone(),
        },
        |packet| match packet.reply() {
            Some(Reply::Hello(welcome)) => {
                packet.saying(&Reply::Hello(Welcome { build: !welcome.build, ..welcome }))
            }
            _ => packet.clone(),
        },
        |packet| match packet.reply() {
            Some(Reply::Capabilities(other)) => packet
                .saying(&Reply::Capabilities(Capabilities { max_height: other.max_height - 1, ..other })),
            _ => packet.clone(),
        },
    ];
    for other in others {
        let report = exchanged_for(other);
        assert_eq!(
            (report.verdict(), report.cause),
            (Verdict::Error, Cause::Refused),
            "{}",
            report.headline()
        );
        assert_eq!(report.finding, Finding::BoardExchanged {});
    }
}

/// What a system says of a device that is gone differs from driver to driver.
#[test]
fn a_board_whose_device_fails_may_come_back_as_one_that_hangs_up() {
    let candidate = Altered::new(&Options::default(), |_, packet| vec![packet]).candidate();
    let mut sent = 0;
    let link = Through::boxed(candidate.link, move |link, out, back, wait| {
        if sent > 5000 {
            let source = std::io::Error::from_raw_os_error(71);
            return Err(LinkError::Failed { link: link.name(), at: link.now(), source });
        }
        sent += out.len();
        link.exchange(out, back, wait)
    });
    let candidate = Candidate { link, reopen: Some(Box::new(|| Ok(board(false)))), ..candidate };
    let report = judge_reconnecting(&System::TINY.plan(), Some(LIMIT), candidate);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
}

/// It says nothing from the first request on that none of its kind knows. That is no answer that is wrong, and no end of the run.
#[test]
fn a_board_that_loses_its_power_where_it_must_refuse_is_waited_for() {
    let mut is_off = false;
    let alter = move |toward, packet: Passing| {
        is_off |= toward == Toward::Board && packet.is(Kind::RowOut);
        if is_off { Vec::new() } else { vec![packet] }
    };
    let candidate = Altered::new(&Options::default(), alter).candidate();
    let candidate = Candidate { reopen: Some(Box::new(|| Ok(board(false)))), ..candidate };
    let report = judge_reconnecting(&System::TINY.plan(), Some(LIMIT), candidate);
    assert_eq!(report.verdict(), Verdict::Pass, "{}", report.headline());
    assert_eq!(report.link.reconnections.len(), 1);
}

/// A sound board over a line of 20,000 bytes a second, of which a run takes some seconds, that is unplugged `after` a time of them.
fn unplugged_after(after: Duration) -> Candidate {
    let candidate = open(SLOW);
    let link = Through::boxed(candidate.link, move |link, out, back, wait| match link.now() {
        at if at >= after => Err(LinkError::Closed { link: link.name(), at }),
        _ => link.exchange(out, back, wait),
    });
    Candidate { link, reopen: Some(Box::new(|| Ok(open(SLOW).link))), ..candidate }
}

const SLOW: &str = "mock,speed=20000";

/// And so do the time that it takes and what goes over both links.
#[test]
fn a_time_limit_counts_on_behind_an_outage() {
    let plan = streamed(System::TINY.plan());
    let judged = |timeout, candidate| {
        let options = RunOptions { timeout, reconnect: Some(LIMIT), ..RunOptions::default() };
        verify(&plan, candidate, &options, &Silent).unwrap().report
    };
    let sound = judged(None, open(SLOW)).link;
    let half = Duration::from_secs_f64(sound.seconds / 2.0);
    let back = judged(None, unplugged_after(half));
    assert_eq!((back.verdict(), back.link.reconnections.len()), (Verdict::Pass, 1), "{}", back.headline());
    let link = back.link;
    assert!(link.seconds > sound.seconds && link.bytes_out > sound.bytes_out, "{link:?}, {sound:?}");
    // The second half and what is uploaded anew end on their own link's clock.
    let limit = Duration::from_secs_f64(0.95 * sound.seconds);
    let late = judged(Some(limit), unplugged_after(half));
    assert_eq!((late.verdict(), late.cause), (Verdict::Error, Cause::Station), "{}", late.headline());
    assert!(late.headline().contains("within its time limit"), "{}", late.headline());
    assert_eq!(late.link.reconnections.len(), 1);
}

#[test]
fn a_time_limit_counts_on_behind_two_outages() {
    let plan = streamed(System::TINY.plan());
    let judged = |timeout, candidate| {
        let options = RunOptions { timeout, reconnect: Some(LIMIT), ..RunOptions::default() };
        verify(&plan, candidate, &options, &Silent).unwrap().report
    };
    let sound = Duration::from_secs_f64(judged(None, open(SLOW)).link.seconds);
    let twice = || {
        let mut times = 0;
        let reopen = move || {
            times += 1;
            Ok(if times == 1 { unplugged_after(sound / 3) } else { open(SLOW) }.link)
        };
        Candidate { reopen: Some(Box::new(reopen)), ..unplugged_after(sound / 3) }
    };
    let back = judged(None, twice());
    assert_eq!((back.verdict(), back.link.reconnections.len()), (Verdict::Pass, 2), "{}", back.headline());
    assert!(back.link.seconds > sound.mul_f64(1.6).as_secs_f64(), "{:?}", back.link);
    // The last link alone and either of those before take less.
    let late = judged(Some(sound.mul_f64(1.5)), twice());
    assert_eq!((late.verdict(), late.cause), (Verdict::Error, Cause::Station), "{}", late.headline());
    assert!(late.headline().contains("within its time limit"), "{}", late.headline());
    assert_eq!(late.link.reconnections.len(), 2);
}

#[test]
fn what_went_over_a_link_that_broke_for_good_counts_once() {
    let sent = |reconnect| {
        let away = || Err(std::io::Error::other("away").into());
        let report = unplugged_behind_the_fifth_row(Passing::clone, Some(Box::new(away)), reconnect);
        assert_eq!(report.verdict(), Verdict::Error, "{}", report.headline());
        // Not bytes: how long a packet is on the wire depends on the session's drawn number.
        (report.link.packets_out, report.link.packets_in)
    };
    assert_eq!(sent(None), sent(Some(Duration::ZERO)));
}

/// The report on a run that keeps within a time, over a link that breaks at the first echo, by which the run chooses what to take.
fn unplugged_while_choosing(reconnect: Option<Duration>) -> Report {
    let is_cut = Arc::new(AtomicBool::new(false));
    let cut = Arc::clone(&is_cut);
    let alter = move |_, packet: Passing| {
        cut.fetch_or(packet.is(Kind::Echo), Ordering::Relaxed);
        vec![packet]
    };
    let reopen: Reopener = Box::new(|| Ok(board(false)));
    let candidate = Candidate { reopen: Some(reopen), ..breakable(alter, is_cut) };
    let plan = Plan { within: Some(LIMIT), ..System::TINY.plan() };
    judge_reconnecting(&plan, reconnect, candidate)
}

#[test]
fn a_board_that_goes_away_while_the_run_chooses_what_to_take_is_named_and_may_come_back() {
    for (reconnect, verdict, times) in [(None, Verdict::Error, 0), (Some(LIMIT), Verdict::Pass, 1)] {
        let report = unplugged_while_choosing(reconnect);
        assert_eq!(report.verdict(), verdict, "{}", report.headline());
        assert_eq!(report.link.reconnections.len(), times);
        assert!(report.board.identity.is_some());
    }
}

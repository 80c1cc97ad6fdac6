//! Frames that a board makes on its own, corrected by grids.

use halfrow_protocol::message::{Burst, BurstMode, FrameRecord, Hello, Request, Reset, ResetLevel, Shape};

use crate::at_speed::{FRAME, HEIGHT, ONE, activate, golden_tables, ready_with};
use crate::bench::{Bench, HELLO};
use crate::frames::WIDTH;
use crate::grids::{greeted, narrow};
use crate::material::{drawn_grid, hermite};
use crate::uploads::TableSet;
use crate::{Boards, Build};

const SHAPE: Shape = Shape { v: 1, k: 5 };

/// The signature of the page's frame of four rows, corrected by the grid drawn from the seed 7 with Hermite's kernel. Computed
/// outside the project.
const DRAWN: u32 = 0xf9c8_e792;

fn grid() -> TableSet {
    TableSet::grid(SHAPE, &drawn_grid(SHAPE, WIDTH, HEIGHT, 7), &hermite())
}

/// A board that makes bursts and takes grids, with these tables active as generation 1; and a burst of one frame with as much
/// blanking as it needs.
fn ready(on: &dyn Boards, tables: &TableSet) -> Option<(Bench, Burst)> {
    let build = Build::default();
    let (_, grids) = greeted(on, &build)?;
    let (bench, bursts) = ready_with(on, &build, narrow(&grids, HEIGHT), tables)?;
    let frame_blanking = bursts.least_frame_blanking.max(grids.grid_blanking.into());
    Some((bench, Burst { frame_blanking, ..ONE }))
}

/// An alternating burst whose frame 1, which is made with the shadow bank, has the number 0.
fn to_the_shadow(one: Burst) -> Burst {
    Burst { frames: 2, first_frame: u16::MAX, mode: BurstMode::Alternating, ..one }
}

fn made(record: FrameRecord) -> (u32, u8) {
    (record.signature, record.generation)
}

pub(crate) fn a_burst_goes_through_the_grid(on: &dyn Boards) {
    let Some((mut bench, one)) = ready(on, &grid()) else { return };
    let repeating = Burst { frames: 3, mode: BurstMode::Repeating, ..one };
    let records = bench.signed(&repeating);
    assert_eq!(records.into_iter().map(made).collect::<Vec<_>>(), [(DRAWN, 1); 3]);
}

pub(crate) fn an_alternating_burst_goes_through_each_banks_own_shape(on: &dyn Boards) {
    let Some((mut bench, one)) = ready(on, &grid()) else { return };
    let even = Burst { mode: BurstMode::Alternating, ..one };
    let odd = to_the_shadow(one);
    golden_tables().upload(&mut bench);
    assert_eq!(made(bench.signed(&even)[0]), (DRAWN, 1));
    assert_eq!(made(bench.signed(&Burst { burst: 2, ..odd })[1]), (FRAME, 0), "the shadow never was a grid");
    bench.done(&golden_tables().commit(2, 1));
    let (_, grids) = greeted(on, &Build::default()).unwrap();
    activate(&mut bench, &narrow(&grids, HEIGHT), 1);
    assert_eq!(made(bench.signed(&Burst { burst: 3, ..even })[0]), (FRAME, 2));
    assert_eq!(
        made(bench.signed(&Burst { burst: 4, ..odd })[1]),
        (DRAWN, 0),
        "the shadow is the grid of before"
    );
    golden_tables().upload(&mut bench);
    assert_eq!(
        made(bench.signed(&Burst { burst: 5, ..odd })[1]),
        (FRAME, 0),
        "row factors were written over the grid"
    );
}

pub(crate) fn a_forgotten_commit_leaves_its_shape_in_the_shadow(on: &dyn Boards) {
    let reset = Request::Reset(Reset { level: ResetLevel::Rows, next_row: 0 });
    for request in [Request::Hello(Hello { nonce: 7, ..HELLO }), reset] {
        let Some((mut bench, one)) = ready(on, &golden_tables()) else { return };
        grid().upload(&mut bench);
        bench.done(&grid().commit(2, 9));
        bench.session = bench.done(&request).header.session;
        assert_eq!(made(bench.signed(&to_the_shadow(one))[1]), (DRAWN, 0), "{request:?}");
    }
}

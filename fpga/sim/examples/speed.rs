//! How fast the simulation is: `cargo run --release -p halfrow-sim --features builds --example speed`.
//!
//! Times are the processor time of this thread where the system reports it (Linux), so that other work on the machine does not
//! count.

use std::time::{Duration, Instant};

use halfrow_pipe::Endpoint;
use halfrow_sim::{Board, Core, CoreBuild, CoreInputs, Front};

const WIDTH: u16 = 1920;
const ROWS: u32 = 1080;

#[allow(clippy::print_stdout)]
fn main() {
    let clocks = u64::from(ROWS) * u64::from(WIDTH);
    let core = timed(|| {
        let mut core = Core::new(CoreBuild::SevenTaps, 1);
        let still = CoreInputs { width: WIDTH, centre2: WIDTH - 1, depth: 2, ..CoreInputs::default() };
        core.clock(&CoreInputs { rst: true, ..still });
        write_tables(&mut core, still);
        for row in 0..ROWS {
            play(&mut core, still, row);
        }
    });
    println!("core: {clocks} pixel clocks, a frame without blanking, in {}", rate(clocks, core));
    for (front, bytes) in [(Front::Bytes, 2_000_000), (Front::Fifo, 50_000), (Front::Uart, 10_000)] {
        let mut board = Board::new(front, 1);
        let garbage = vec![0x55; bytes];
        let taken = timed(|| drop(board.receive(&garbage, Duration::ZERO)));
        println!("{front:?}: {bytes} bytes taken in {}", rate(bytes as u64, taken));
    }
}

fn write_tables(core: &mut Core, still: CoreInputs) {
    for table_entry in 0..1080 {
        let step = CoreInputs { step_write: true, table_entry, table_data: [14_648_488, 0, 0], ..still };
        core.clock(&step);
    }
    for table_entry in 0..65 {
        let word = u32::from(table_entry) << 7;
        core.clock(&CoreInputs { node_write: true, table_entry, table_data: [word; 3], ..still });
    }
}

fn play(core: &mut Core, still: CoreInputs, row: u32) {
    core.clock(&CoreInputs { prepare: true, prepare_row: row as u16, ..still });
    while !core.clock(&still).prepared {}
    let mut noise = row.wrapping_mul(2_654_435_761);
    for column in 0..WIDTH {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let in_sample = (noise >> 20) as u16;
        core.clock(&CoreInputs { enable: true, in_valid: true, in_start: column == 0, in_sample, ..still });
    }
}

fn rate(count: u64, time: Duration) -> String {
    format!("{:.2} s, {:.2} million a second", time.as_secs_f64(), count as f64 / time.as_secs_f64() / 1e6)
}

fn timed(work: impl FnOnce()) -> Duration {
    let (begun, on_processor) = (Instant::now(), processor_time());
    work();
    match (on_processor, processor_time()) {
        (Some(before), Some(after)) => after - before,
        _ => begun.elapsed(),
    }
}

/// The processor time that this thread has used.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
}

//! The mock board's core, which works through a frame pixel clock by pixel clock.

use std::error::Error;
use std::hint::black_box;

use halfrow_mock::{Node, Options, Player, RowIn, Settings, Tables};
use halfrow_model::{Interpolant, Kernel};

use crate::Benchmark;
use crate::scene::{HEIGHT, frame, tables};

pub(crate) fn benchmarks() -> Result<Vec<Benchmark>, Box<dyn Error>> {
    let options = Options::default();
    let (set, frame) = (tables(HEIGHT)?, frame(HEIGHT, 0)?);
    let mut tables = Tables::new(&options, None);
    tables.write_factors(0, &set.entries().collect::<Vec<_>>())?;
    let nodes: Vec<_> = Kernel::from(Interpolant::Hermite).nodes().iter().copied().map(Node::from).collect();
    tables.write_nodes(0, &nodes)?;
    tables.commit(1, 0)?;
    let mut player = Player::new(&options, None)?;
    let geometry = set.geometry();
    player.configure(Settings {
        width: geometry.width() as u16,
        height: geometry.height() as u16,
        centre2: geometry.centre2() as u16,
        ..Settings::at_power_up(&options)
    })?;
    let row = |(row, samples): (usize, &[u16])| RowIn {
        sequence: row as u32,
        frame: 0,
        row: row as u16,
        last: row + 1 == HEIGHT,
        samples: samples.to_vec(),
    };
    let rows: Vec<_> = frame.rows().enumerate().map(row).collect();
    let run = move || {
        for row in &rows {
            let played = player.play(row, &mut tables);
            assert!(played.is_ok(), "{played:?}");
            black_box(player.banks.fetch());
        }
        player.flush();
        while black_box(player.banks.fetch()).is_some() {}
    };
    Ok(vec![Benchmark { name: "mock".to_owned(), run: Box::new(run) }])
}

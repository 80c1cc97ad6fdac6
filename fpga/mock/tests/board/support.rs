//! What the tests feed to the board, made by the paper's formulas and the sample formula of DATAPATH.md.

use std::sync::Arc;

use halfrow_conformance::material;
use halfrow_mock::{
    BoardFault, Core, Depth, Entering, Kernel, Leaving, NODES, Node, Options, Player, RowBinding, RowIn,
    RowOut, Settings, Tables, UNSTRETCHED, board_fault,
};

pub(crate) use halfrow_conformance::material::{GOLDEN_FACTOR, crc_of_words, factors, noise_row};

/// Hermite's five stored weights (Eq. 18).
pub(crate) fn hermite() -> Kernel {
    Kernel { nodes: material::hermite().map(Node::from) }
}

/// Keys' five stored weights (Eq. 12).
pub(crate) fn keys() -> Kernel {
    Kernel { nodes: material::keys().map(Node::from) }
}

/// A kernel with the same weights at every node.
pub(crate) fn constant(node: Node) -> Kernel {
    Kernel { nodes: [node; NODES] }
}

/// A 12-bit row with its centre in the middle.
pub(crate) fn binding(width: u16, factor: u32, kernel: Kernel) -> RowBinding {
    RowBinding {
        width,
        centre2: width - 1,
        depth: Depth::Twelve,
        values: factor.into(),
        kernel: Arc::new(kernel),
    }
}

/// A row that comes out as it went in.
pub(crate) fn unchanged(width: u16) -> RowBinding {
    binding(width, UNSTRETCHED, hermite())
}

/// A core with this latency and this ring, with or without a fault.
pub(crate) fn core(latency: u8, ring: u16, fault: Option<BoardFault>) -> Core {
    let options = Options { latency, ring: Some(ring), max_width: ring.min(2592), ..Options::default() };
    Core::new(&options, fault).unwrap()
}

/// Feeds rows into a core with `blanking` clocks between them, and flushes it. Returns every output with the pixel clock at
/// which it was given; the first sample enters at clock 0.
pub(crate) fn run(
    core: &mut Core,
    rows: &[(Vec<u16>, RowBinding)],
    blanking: usize,
) -> Vec<(usize, Leaving)> {
    let mut inputs = Vec::new();
    for (samples, binding) in rows {
        if !inputs.is_empty() {
            inputs.resize(inputs.len() + blanking, None);
        }
        let entering = samples
            .iter()
            .enumerate()
            .map(|(column, &sample)| Some(Entering { sample, begins: (column == 0).then_some(binding) }));
        inputs.extend(entering);
    }
    let flush = rows.iter().map(|(_, binding)| core.delay(binding.width) as usize).max().unwrap();
    inputs.resize(inputs.len() + flush, None);
    inputs
        .into_iter()
        .map(|input| core.clock(input))
        .enumerate()
        .filter_map(|(t, out)| Some((t, out?)))
        .collect()
}

/// The samples of the row that leaves as number `index`, counted from 0.
pub(crate) fn row_out(outputs: &[(usize, Leaving)], width: u16, index: usize) -> Vec<u16> {
    outputs.chunks(width.into()).nth(index).unwrap().iter().map(|(_, leaving)| leaving.sample).collect()
}

/// The fault called `name`, with parameters in a target string's spelling.
pub(crate) fn fault(name: &str, parameters: &[(&str, &str)]) -> BoardFault {
    board_fault(&[&[("fault", name)], parameters].concat()).unwrap().unwrap()
}

/// A player and its tables for 64 columns and as many rows as there are factors, with the tables committed for frame 0.
pub(crate) fn small_board(fault: Option<BoardFault>, factors: &[u32], kernel: &Kernel) -> (Player, Tables) {
    let options = Options::default();
    let mut player = Player::new(&options, fault).unwrap();
    let mut tables = Tables::new(&options, fault);
    player.configure(small_settings(factors.len() as u16, 0, 0)).unwrap();
    tables.write_factors(0, factors).unwrap();
    tables.write_nodes(0, &kernel.nodes).unwrap();
    tables.commit(1, 0).unwrap();
    (player, tables)
}

/// Settings for 12-bit rows of 64 columns with the centre in the middle.
pub(crate) fn small_settings(height: u16, blanking: u16, gap_seed: u32) -> Settings {
    Settings { width: 64, height, centre2: 63, depth: Depth::Twelve, blanking, gap_seed }
}

/// Plays a frame of DATAPATH.md's golden samples, flushes it and fetches what comes out.
pub(crate) fn play_frame(player: &mut Player, tables: &mut Tables, frame: u16) -> Vec<RowOut> {
    let &Settings { width, height, .. } = player.settings();
    let mut corrected = Vec::new();
    for row in 0..height {
        let samples = noise_row(row.into(), width);
        let last = row + 1 == height;
        player.play(&RowIn { sequence: row.into(), frame, row, last, samples }, tables).unwrap();
        corrected.extend(std::iter::from_fn(|| player.banks.fetch()));
    }
    player.flush();
    corrected.extend(std::iter::from_fn(|| player.banks.fetch()));
    corrected
}

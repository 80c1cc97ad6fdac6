//! Bytes at the bridge's own ports: the board without a front end, as fast as it takes bytes.

use std::path::Path;

use crate::board::Failure;
use crate::ffi::{BridgeInputs, BridgeOutputs, Design, Functions};
use crate::port::{Port, Step};

/// `halfrow_bridge`, with a byte per clock each way.
pub(crate) struct BytePort(Design<BridgeInputs, BridgeOutputs>);

impl BytePort {
    pub(crate) fn new(functions: &'static Functions<BridgeInputs, BridgeOutputs>, seed: u32) -> Self {
        Self(Design::new(functions, seed))
    }
}

impl Port for BytePort {
    const REST: u32 = 8;

    fn step(&mut self, offered: Option<u8>, millisecond: bool) -> Result<Step, Failure> {
        let rx_data = offered.unwrap_or_default();
        let inputs =
            BridgeInputs { rst: false, rx_valid: offered.is_some(), rx_data, tx_ready: true, millisecond };
        let outputs = self.0.clock(&inputs);
        Ok(Step {
            taken: offered.is_some() && outputs.rx_ready,
            sent: outputs.tx_valid.then_some(outputs.tx_data),
            quiet: offered.is_none() && outputs.quiet,
        })
    }

    fn reset(&mut self) {
        for _ in 0..4 {
            self.0.clock(&BridgeInputs { rst: true, ..BridgeInputs::default() });
        }
    }

    fn trace(&mut self, path: &Path) -> bool {
        self.0.trace(path)
    }

    fn is_traced(&mut self) -> bool {
        self.0.is_traced()
    }
}

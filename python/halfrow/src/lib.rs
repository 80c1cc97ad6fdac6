//! `halfrow._halfrow`: the library `halfrow` as an extension module, which the Python package in python/halfrow/python wraps.
//!
//! ```text
//!  arrays ── NumPy's samples, never copied      errors ── codes, messages, remedies
//!  lens ─► tables ─┐
//!  kernel ─────────┼─► correct    ─► arrays
//!  frames ─────────┴─► verify     ─► run: JSON, text, the folder of a report
//!                      └ watched: signals and progress while a run has a thread of its own
//! ```

#![allow(clippy::needless_pass_by_value, reason = "what Python hands over is made for the call")]

mod arguments;
mod arrays;
mod choices;
mod correct;
mod errors;
mod frames;
mod kernel;
mod lens;
mod outputs;
mod plan;
mod run;
mod tables;
mod verify;
mod watched;

use pyo3::pymodule;

/// Judges boards and corrects frames with the library `halfrow`.
#[pymodule]
mod _halfrow {
    use halfrow::frames::Builtin;
    use halfrow::kernels::NamedKernel;
    use halfrow::model::ModelPath;
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::correct::{Corrector, correct};
    #[pymodule_export]
    use super::frames::{demosaic, read_frame, write_frame};
    #[pymodule_export]
    use super::kernel::Kernel;
    #[pymodule_export]
    use super::lens::Lens;
    #[pymodule_export]
    use super::run::Run;
    #[pymodule_export]
    use super::tables::Tables;
    #[pymodule_export]
    use super::verify::verify;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("VERSION", halfrow::VERSION)?;
        module.add("KERNELS", NamedKernel::ALL.map(NamedKernel::name))?;
        module.add("BUILTIN_FRAMES", Builtin::ALL.map(Builtin::name))?;
        module.add("MODEL_PATHS", ModelPath::available().map(ModelPath::name).collect::<Vec<_>>())
    }
}

//! Translates the Verilog in `fpga/rtl` to C++ with Verilator and compiles it, once for every build of the design that
//! `src/builds.rs` offers.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};

/// A top module with its parameters, and the name of the C++ class that it becomes.
struct Model {
    class: &'static str,
    top: &'static str,
    parameters: &'static [&'static str],
}

const MODELS: [Model; 3] = [
    Model { class: "Core7", top: "halfrow_core", parameters: &["TAPS=7"] },
    Model { class: "Core5", top: "halfrow_core", parameters: &["TAPS=5"] },
    Model { class: "CoreShort", top: "halfrow_core", parameters: &["TAPS=7", "RING_BITS=7"] },
];

const REMEDY: &str = "install it with `apt-get install verilator g++`, or build without `--features sim`";

fn main() {
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let rtl = folder.join("../rtl");
    println!("cargo::rerun-if-changed={}", rtl.display());
    println!("cargo::rerun-if-changed=shim");
    println!("cargo::rerun-if-env-changed=VERILATOR");
    let verilator = Verilator::find();
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    let sources = MODELS.iter().flat_map(|model| verilator.translate(model, &rtl, &out)).collect();
    verilator.compile(sources, &out);
}

/// The Verilator of this machine.
struct Verilator {
    program: String,
    /// The folder with the library that its models are linked with.
    include: PathBuf,
}

impl Verilator {
    fn find() -> Self {
        let program = env::var("VERILATOR").unwrap_or_else(|_| "verilator".to_owned());
        let version = said(Command::new(&program).arg("--version"));
        let version = version.unwrap_or_else(|| fail(&format!("`{program}` cannot be run; {REMEDY}")));
        // Verilator 5.006 2023-01-22 rev (Debian 5.006-3)
        let number = version.split_whitespace().nth(1).unwrap_or_default();
        if !number.starts_with("5.") {
            fail(&format!("Verilator 5 is needed, and `{program}` is {number}; {REMEDY}"));
        }
        let root = said(Command::new(&program).args(["--getenv", "VERILATOR_ROOT"]));
        let root = root.unwrap_or_else(|| fail(&format!("`{program}` does not know its VERILATOR_ROOT")));
        Self { program, include: Path::new(root.trim()).join("include") }
    }

    /// Translates one model. Returns its C++ files.
    fn translate(&self, model: &Model, rtl: &Path, out: &Path) -> Vec<PathBuf> {
        let folder = out.join(model.class);
        // What a module that is gone left behind would be compiled as well.
        let _ = fs::remove_dir_all(&folder);
        let mut command = Command::new(&self.program);
        command.args(["--cc", "-O3", "--trace", "--x-assign", "fast", "--x-initial", "unique", "-Wno-fatal"]);
        command.args(["--top-module", model.top, "--prefix", model.class]).arg("--Mdir").arg(&folder);
        command.args(model.parameters.iter().map(|parameter| format!("-G{parameter}")));
        command.arg("-y").arg(rtl).arg(rtl.join(model.top).with_extension("v"));
        match command.output() {
            Ok(output) if output.status.success() => {}
            Ok(output) => fail(&format!("{command:?} failed:\n{}", String::from_utf8_lossy(&output.stderr))),
            Err(error) => fail(&format!("{command:?} failed: {error}")),
        }
        files(&folder, "cpp")
    }

    fn compile(&self, mut sources: Vec<PathBuf>, out: &Path) {
        for file in ["verilated.cpp", "verilated_threads.cpp", "verilated_vcd_c.cpp"] {
            sources.push(self.include.join(file));
        }
        let mut build = cc::Build::new();
        build
            .cpp(true)
            .std("c++17")
            .opt_level(3)
            .debug(false)
            .warnings(false)
            .define("VL_TIME_CONTEXT", None);
        build.define("VM_TRACE", "1").define("VM_TRACE_VCD", "1").define("VM_TRACE_FST", "0");
        build.include(&self.include).include(self.include.join("vltstd"));
        for model in &MODELS {
            build.include(out.join(model.class));
        }
        build.files(sources).file("shim/designs.cpp").compile("halfrow_designs");
        println!("cargo::rustc-link-lib=pthread");
    }
}

/// What a command prints, if it runs and succeeds.
fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == extension));
    files.sort();
    files
}

fn fail(why: &str) -> ! {
    println!("cargo::error=halfrow-sim: {why}");
    exit(1)
}

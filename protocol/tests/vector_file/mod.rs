//! The frozen vectors on disk; `vectors/README.md` describes their form.

use std::fs;
use std::path::Path;

/// Every vector: its name and its text, in the order of the names.
pub(crate) fn read_all() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors");
    let mut files: Vec<_> = fs::read_dir(folder)
        .expect("the folder of the vectors")
        .map(|entry| entry.expect("an entry of the folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "hex"))
        .map(|path| {
            let name = path.file_name().expect("a file's name").to_string_lossy().into_owned();
            (name, fs::read_to_string(path).expect("a vector's text"))
        })
        .collect();
    files.sort();
    files
}

/// The bytes of a vector, as Verilog's `$readmemh` reads them.
pub(crate) fn bytes(text: &str) -> Vec<u8> {
    text.lines()
        .flat_map(|line| line.split("//").next().unwrap_or_default().split_whitespace())
        .map(|byte| u8::from_str_radix(byte, 16).expect("two hexadecimal digits"))
        .collect()
}

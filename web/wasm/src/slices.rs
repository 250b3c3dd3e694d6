//! A file of the browser, read in slices: never is all of it in memory.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom};

use js_sys::{Function, Uint8Array};
use wasm_bindgen::{JsCast, JsValue};

/// Bytes of a slice.
const SLICE: u64 = 1 << 20;

thread_local! {
    /// What reads a slice of each file: `(from, to) => Uint8Array`. It stays here, for what decodes may be of any thread.
    static READERS: RefCell<BTreeMap<u32, Function>> = const { RefCell::new(BTreeMap::new()) };
}

/// A file that can be read as often as is wanted.
#[derive(Debug)]
pub(crate) struct File {
    id: u32,
    size: u64,
}

impl File {
    pub(crate) fn new(size: u64, read: Function) -> Self {
        READERS.with_borrow_mut(|readers| {
            let id = readers.last_key_value().map_or(0, |(last, _)| last + 1);
            readers.insert(id, read);
            Self { id, size }
        })
    }

    /// The file from its start.
    pub(crate) const fn slices(&self) -> Slices {
        Slices {
            id: self.id,
            size: self.size,
            position: 0,
            from: 0,
            slice: Vec::new(),
        }
    }
}

impl Drop for File {
    fn drop(&mut self) {
        READERS.with_borrow_mut(|readers| readers.remove(&self.id));
    }
}

/// One reading of a file.
#[derive(Debug)]
pub(crate) struct Slices {
    id: u32,
    size: u64,
    position: u64,
    /// Where the slice in memory begins.
    from: u64,
    slice: Vec<u8>,
}

impl Slices {
    /// What is in memory from the position on; a slice is fetched where nothing is.
    fn rest(&mut self) -> Result<&[u8]> {
        let end = self.from + length(&self.slice);
        if !(self.from..end).contains(&self.position) {
            let to = self.size.min(self.position + SLICE);
            self.slice = fetch(self.id, self.position.min(to), to)?;
            self.from = self.position;
        }
        let skipped = usize::try_from(self.position - self.from).unwrap_or(usize::MAX);
        Ok(self.slice.get(skipped..).unwrap_or_default())
    }
}

const fn length(bytes: &[u8]) -> u64 {
    bytes.len() as u64
}

#[expect(clippy::cast_precision_loss, reason = "no file has 2^53 bytes")]
fn fetch(id: u32, from: u64, to: u64) -> Result<Vec<u8>> {
    if from >= to {
        return Ok(Vec::new());
    }
    let read = READERS.with_borrow(|readers| readers.get(&id).cloned());
    let read = read.ok_or_else(|| Error::from(ErrorKind::NotFound))?;
    let slice = read.call2(&JsValue::NULL, &(from as f64).into(), &(to as f64).into());
    let slice = slice.and_then(JsCast::dyn_into::<Uint8Array>);
    slice
        .map(|bytes| bytes.to_vec())
        .map_err(|_| Error::other("the browser cannot read this file any more: choose it again"))
}

impl Read for Slices {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let rest = self.rest()?;
        let count = rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&rest[..count]);
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for Slices {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::End(offset) => self.size.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.position.checked_add_signed(offset),
        };
        self.position = place.ok_or_else(|| Error::from(ErrorKind::InvalidInput))?;
        Ok(self.position)
    }
}

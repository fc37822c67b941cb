//! Memory of ours for `NumPy`: no copy, read-only, kept as long as an array uses it.

use std::any::Any;
use std::sync::Arc;

use burgeon::glam::DVec3;
use burgeon::plant::AxisId;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Owner of the memory.
pub(crate) type Owner = Arc<dyn Any + Send + Sync>;

/// Layout of a row for `NumPy`'s array interface: the count of its numbers (1 for a plain one), and their type.
pub(crate) trait Row: 'static {
    const WIDTH: usize;
    const TYPE: &'static str;
}

macro_rules! rows {
    ($($number:ty = $word:literal),*) => {$(
        impl Row for $number {
            const WIDTH: usize = 1;
            const TYPE: &'static str = $word;
        }
        impl<const N: usize> Row for [$number; N] {
            const WIDTH: usize = N;
            const TYPE: &'static str = $word;
        }
    )*};
}

#[cfg(target_endian = "little")]
rows!(f64 = "<f8", f32 = "<f4", u32 = "<u4", i32 = "<i4", u8 = "|u1");
#[cfg(target_endian = "big")]
rows!(f64 = ">f8", f32 = ">f4", u32 = ">u4", i32 = ">i4", u8 = "|u1");

/// `repr(C)`: three numbers, one after the other.
impl Row for DVec3 {
    const WIDTH: usize = 3;
    const TYPE: &'static str = <f64 as Row>::TYPE;
}

/// A wrapper of one number.
impl Row for AxisId {
    const WIDTH: usize = 1;
    const TYPE: &'static str = <u32 as Row>::TYPE;
}

const _: () = assert!(size_of::<AxisId>() == size_of::<u32>(), "a handle is its number");

/// A column of a table or mesh, for `numpy.asarray`.
#[pyclass(frozen, module = "burgeon._burgeon")]
pub(crate) struct Column {
    /// Keeps the rows at their address.
    _owner: Owner,
    address: usize,
    shape: Vec<usize>,
    kind: &'static str,
}

impl Column {
    /// Returns a column of rows that `owner` keeps and nothing changes.
    pub(crate) fn from_rows<T: Row>(owner: Owner, rows: &[T]) -> Self {
        let shape = if T::WIDTH == 1 { vec![rows.len()] } else { vec![rows.len(), T::WIDTH] };
        Self { _owner: owner, address: rows.as_ptr().expose_provenance(), shape, kind: T::TYPE }
    }

    /// Returns a column that owns its rows.
    pub(crate) fn new<T: Row + Send + Sync>(rows: Vec<T>) -> Self {
        let owner = Arc::new(rows);
        let kept: Owner = owner.clone();
        Self::from_rows(kept, &owner)
    }

    /// Returns the same numbers in another shape of the same size.
    pub(crate) fn shaped(mut self, shape: &[usize]) -> Self {
        debug_assert_eq!(
            shape.iter().product::<usize>(),
            self.shape.iter().product::<usize>(),
            "as many numbers"
        );
        self.shape = shape.to_vec();
        self
    }
}

#[pymethods]
impl Column {
    /// Returns version 3 of the interface: address, read-only flag, shape and type.
    #[getter(__array_interface__)]
    fn interface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("version", 3)?;
        dict.set_item("typestr", self.kind)?;
        dict.set_item("shape", pyo3::types::PyTuple::new(py, &self.shape)?)?;
        dict.set_item("data", (self.address, true))?;
        Ok(dict)
    }
}

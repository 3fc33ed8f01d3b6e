//! The contacts of stickslip as a C library, installed as `libstickslip` with the header `include/stickslip.h`.
//!
//! | module | question |
//! |---|---|
//! | [`exports`] | which functions does a program in C, C++ or Fortran call? The header is printed from this file |
//! | [`contact`] | what is a contact of theirs, with its trial? |
//! | [`handles`] | which contact does a handle name, and does that contact still exist? |
//! | [`fault`] | which code does a failed call return, and which text? |
//!
//! A handle is a number and not an address: one that has been freed, or was never made, is refused, and two threads
//! that use one contact at once are told so. So `unsafe` is needed for the numbers and texts of the caller alone.

pub mod contact;
pub mod exports;
pub mod fault;
pub mod handles;

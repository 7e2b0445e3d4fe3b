//! What every structure promises, held against brute force.

mod agree;
mod common;
mod divided_space;

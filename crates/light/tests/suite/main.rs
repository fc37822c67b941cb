//! Light against closed forms, against itself on several threads, and against paths that are drawn by chance.

mod canopies;
mod plates;
mod rami;
mod scenes;

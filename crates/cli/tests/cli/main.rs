//! The program as its users meet it: each test writes tiny scenes and runs the binary on them.

mod arguments;
mod bad_input;
mod bench;
mod compare;
mod develop;
mod explain;
mod films;
mod images;
mod info;
mod interrupt;
mod layers;
mod mitsuba;
mod outputs;
mod pyramid;
mod render;
mod replay;
mod scene_tests;
mod suspicious;
mod verify;
mod video;

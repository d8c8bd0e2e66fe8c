//! A real browser that plays our files, where there is one.

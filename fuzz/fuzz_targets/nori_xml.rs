#![no_main]

caustica_fuzz::target!("nori_xml");

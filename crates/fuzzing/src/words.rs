//! The words of the formats: what random bytes would not find.

/// Tags, plugins, properties and values of scene files.
pub const NORI: &[&str] = &[
    "<scene>", "</scene>", "<test type=\"ttest\">", "<test type=\"chi2test\">", "</test>", "<!--", "-->", "<![CDATA[", "]]>",
    "<?xml version=\"1.0\"?>", "<!DOCTYPE x>", "&lt;", "&#x41;", "&#0;", "xmlns:a=\"b\"", "a:", "/>", " type=\"", " name=\"",
    " value=\"", " id=\"", "toWorld", "<transform name=\"toWorld\">", "</transform>", "<translate value=\"0,0,1\"/>",
    "<scale value=\"1,2,-1\"/>", "<rotate angle=\"45\" axis=\"0,1,0\"/>",
    "<lookat origin=\"0,0,-3\" target=\"0,0,0\" up=\"0,1,0\"/>", "<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\"/>",
    "<camera type=\"perspective\"/>", "thinlens", "orthographic", "environment", "fov", "nearClip", "farClip", "width", "height",
    "cropOffsetX", "cropOffsetY", "cropWidth", "cropHeight", "apertureRadius", "focusDistance", "<rfilter type=\"gaussian\"/>",
    "mitchell", "tent", "box", "radius", "stddev", "<film>", "</film>", "<sampler type=\"independent\"/>", "sampleCount",
    "<integrator type=\"bdpt\"/>", "normals", "depth", "ao", "av", "length", "simple", "directional", "whitted", "direct",
    "direct_mats", "direct_ems", "path", "path_ems", "path_mats", "naive", "light", "position", "energy", "direction",
    "irradiance", "<mesh type=\"obj\">", "<mesh type=\"sphere\"/>", "</mesh>", "filename", "tri.obj", "sky.exr", "tile.png",
    "tile.jpg", "../tri.obj", "center", "<bsdf type=\"diffuse\"/>", "</bsdf>", "mirror", "dielectric", "roughdielectric",
    "conductor", "roughconductor", "microfacet", "albedo", "reflectance", "intIOR", "extIOR", "alpha", "distribution", "ggx",
    "material", "Cu", "Au", "eta", "k", "kd", "<emitter type=\"area\">", "</emitter>", "radiance", "point", "spot", "spotlight",
    "constant", "envmap", "power", "intensity", "innerAngle", "outerAngle", "cosTotalWidth", "target", "strength",
    "<texture type=\"checkerboard_color\"/>", "image_texture", "constant_color", "value1", "value2", "delta", "offset",
    "<integer name=\"width\" value=\"1\"/>", "<float name=\"radius\" value=\"1\"/>", "<color name=\"radiance\" value=\"1,1,1\"/>",
    "<point name=\"center\" value=\"0,0,0\"/>", "<vector name=\"direction\" value=\"0,0,1\"/>",
    "<string name=\"filename\" value=\"tri.obj\"/>", "<boolean name=\"a\" value=\"true\"/>", "significanceLevel", "references",
    "angles", "distances", "resolution", "minExpFrequency", "testCount", "medium", "phase", "disney",
];

/// Numbers at the edges of what their types hold.
pub const NUMBERS: &[&str] = &[
    "0", "-0", "1", "-1", "2", "0.5", "1e-3", "-1e-3", "1e-6", "1e6", "1e10", "-1e15", "1e19", "-1e20", "1e38", "3.4028235e38",
    "3.5e38", "1e-38", "1e-45", "1e-46", "1e308", "-1e308", "1e309", "5e-324", "inf", "-inf", "nan", "0.9999999", "1.0000001",
    "89.999", "90", "179.9999", "180", "180.0001", "255", "256", "4096", "65535", "65536", "65537", "2147483647", "2147483648",
    "-2147483649", "4294967295", "4294967296", "9223372036854775807", "9223372036854775808", "1e", ".", "+.5", "0x10", "1_000",
];

/// Statements of meshes.
pub const OBJ: &[&str] = &[
    "v ", "\nv 0 0 0\n", "vt ", "\nvt .5 .5\n", "vn ", "\nvn 0 0 1\n", "f ", "\nf 1 2 3\n", "\nf 1/1/1 2/2/1 3/3/1\n",
    "\nf -1 -2 -3\n", "//", "/", "\\\n", "#", "\r\n", "g x\n", "usemtl a\n", "mtllib a.mtl\n", "s off\n", "o a\n", "l 1 2\n", "p 1\n",
    "1//1", "-1//-1", "1/1", " 0", "1e38", "3.4028235e38", "-3.4028235e38", "1e-45", "nan", "inf", "999999999999999999",
    "9999999999999999999", "-999999999999999999", "4294967296", "4294967295", "2147483648",
];

/// Chunk names, markers and attribute names of images.
pub const IMAGES: &[&str] = &[
    "\u{89}PNG", "IHDR", "PLTE", "IDAT", "IEND", "tRNS", "gAMA", "cHRM", "sRGB", "iCCP", "iTXt", "zTXt", "acTL", "fcTL", "fdAT",
    "JFIF\0", "Exif\0\0", "Adobe\0", "ICC_PROFILE\0", "channels\0", "chlist\0", "compression\0", "dataWindow\0",
    "displayWindow\0", "box2i\0", "lineOrder\0", "tiles\0", "tiledesc\0", "name\0", "type\0", "string\0", "scanlineimage\0",
    "tiledimage\0", "deepscanline\0", "chunkCount\0", "version\0", "R\0", "G\0", "B\0", "Y\0",
];

/// The same for films, with the names of their own attributes.
pub const EXR: &[&str] = &[
    "channels\0", "chlist\0", "compression\0", "dataWindow\0", "displayWindow\0", "box2i\0", "lineOrder\0", "tiles\0",
    "tiledesc\0", "name\0", "type\0", "string\0", "scanlineimage\0", "tiledimage\0", "deepscanline\0", "chunkCount\0", "version\0",
    "eye.R\0", "eye.G\0", "eye.B\0", "light.R\0", "light.G\0", "light.B\0", "combined.R\0", "caustica.samples\0",
    "caustica.lightPasses\0", "18446744073709551615", "-1",
];

"""What the written scene files have in common."""


def head(about, look, fov, size, note=""):
    """The file up to its shapes: a comment, and a camera that looks from the first point to the second."""
    origin, target = (", ".join(map(str, point)) for point in look)
    width, height = size
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!-- Written by scenes/generate.py. {about} -->
<scene>
	<integrator type="bdpt"/>
	<camera type="perspective">
		<transform name="toWorld">
			<lookat origin="{origin}" target="{target}" up="0, 1, 0"/>
		</transform>
{note}		<float name="fov" value="{fov}"/>
		<integer name="width" value="{width}"/>
		<integer name="height" value="{height}"/>
		<rfilter type="tent"/>
	</camera>
	<sampler type="independent">
		<integer name="sampleCount" value="256"/>
	</sampler>

"""

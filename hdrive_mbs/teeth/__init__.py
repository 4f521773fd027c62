"""Teeth of the harmonic and the double harmonic transmission: pure geometry, numpy and scipy only.

Signs, used in every file here.  The frame of a tooth is the paper's S2: origin where the starting
axis meets the undeformed neutral fibre, y radially outwards, x along the tangent.  Displacement v,
section rotation theta and all turning are positive towards +x.  The wave generator turns towards
+x by the angle phi, counted from the starting axis *relative to the flexspline* (minor axis for
outward, major axis for inward flexible teeth), so in the generator's frame the tooth runs backwards:
it is at s = s_start - phi, s counted from the major axis towards +x.  Then, to first order,

    dv/ds = -w,   theta = (v - dw/ds) / r0

and the flexible tooth turns by  a = phi (z_flexible - z_rigid) / z_rigid  against the rigid wheel.
For w = w0 cos 2s this is, as a function of phi,

    outward teeth, from the minor axis:  w = -w0 cos 2phi, v = -(w0/2) sin 2phi, theta = +(3 w0/2 r0) sin 2phi
    inward teeth, from the major axis:   w = +w0 cos 2phi, v = +(w0/2) sin 2phi, theta = -(3 w0/2 r0) sin 2phi

Source: Draghita Ianici, Sava Ianici, Studying the relative positions of the teeth of conjugated
wheels in the double harmonic transmission, Analele Universitatii "Eftimie Murgu" Resita (2017),
here "seed I".  Misprints in it, each shown by a test:

* (3), first line: r_a3 must be r_a2 (P would leave its tooth);
* (7)-(8): with v and theta counted in one sense, as in (3)-(4), the theta term needs a plus; the
  printed minus holds only with theta = +(3 w0/2 r0) sin 2phi, the function of the other stage;
* phi3, phi4 - phi2 are not given: 2 phi/z3 and 2 phi/z4 for teeth counts that differ by 2;
* \\|i\\| = 50, m = 0.3 mm and r02 = 29.3 mm do not go together with one unshifted module: the ratio needs
  (z2 - 100)(z4 - 100) = 10200, so z2 + z4 >= 402, a fibre in the middle of the rim z2 + z4 = 388.7.
"""

"""The claim of the tutorial "Checking a published claim" over the damping of the bearings."""

from docs.gallery.make import ran
from hdrive_mbs.plots.look import given_or_new, house_look, style


def make():
    left = ran("checking_a_claim")
    with house_look():
        axes = given_or_new(None)
        for k in (0, 1):
            axes.plot(left["shares"], 100.0 * left["higher"][:, k], marker="o", **style(k), label=f"rotor {k + 1}, simplified")
        axes.plot(left["shares"], 100.0 * left["improved"][:, 0], **style(2), label="rotor 1, improved")
        axes.axhline(0.0, color="#666666", linewidth=0.8)
        axes.set(xlabel="damping of the bearings, share of 20 kN s/m", ylabel="first peak against the full model [%]")
        axes.set_title('"The transverse amplitudes are higher": where that holds')
        axes.legend()
    return axes

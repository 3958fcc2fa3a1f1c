"""A small skeleton and a clip, as texts, that several tests read."""

from mocap.files import load_save

ASF = """# a leg and an arm
:version 1.10
:name hand made
:units
  mass 1.0
  length 0.0254   # so that a unit is a metre
  angle deg
:documentation
   begin, end and root mean nothing here
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hip
     direction 0 -1 0
     length 1
     axis 0 0 0 XYZ
  end
  begin
     id 7
     name thigh
     direction 0 -1 0
     length 2
     axis 0 0 90 XYZ
     dof rx rz
     limits (-160.0 20.0)
            (-inf inf)
  end
  begin
     id 9
     name stray
     direction 1 0 0
     length 3
     axis 0 0 0 XYZ
     dof ry
  end
  begin
     id 12
     name arm
     direction 1 0 0
     length 1
     axis 0 0 0 XYZ
     dof rz ry
  end
:hierarchy
  begin
    root hip arm
    hip thigh
  end
:skin none.obj
"""
AMC = """#!OML:ASF hand.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 0 5 0 0 0 0
thigh 0 0
arm 0 0
2
root 1 5 0 0 90 0
thigh 90 0
arm 90 90
"""
SPINE = """:root
  order TX TY TZ RX RY RZ
:bonedata
  begin
    name spine
    direction 0 1 0
    length 1
    axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  root spine
"""


def read_clip(write, asf=ASF, amc_text=AMC, **options):
    return load_save.load(write("a.amc", amc_text), skeleton=write("a.asf", asf), **options)

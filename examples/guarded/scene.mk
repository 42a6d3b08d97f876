SCENE_DESC := drop, and no contact gives back more energy than it was given
SCENE_SRC  := examples/guarded/guarded.c examples/drop/drop.c

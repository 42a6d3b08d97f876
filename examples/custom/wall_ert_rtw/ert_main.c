/* The generator's example of a main program; a project brings its own. */
#include "wall.h"

int_T main(void)
{
  wall_initialize();
  while (rtmGetErrorStatus(wall_M) == 0) {
    wall_step();
  }

  wall_terminate();
  return 0;
}

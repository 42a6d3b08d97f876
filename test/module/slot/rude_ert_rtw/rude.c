/* Model rude: 5 N in contact, or what k says instead. */
#include "rude.h"
#include <math.h>

/* Model step function */
void rude_step(RT_MODEL_rude_T *const rude_M, real_T rude_U_k, boolean_T
               rude_U_c, real_T rude_U_t, real_T *rude_Y_f)
{
  static const real_T huge = 1.0E+300;
  volatile real_T wait;
  const int_T what = (int_T)(rude_U_k + 0.5);

  *rude_Y_f = 0.0;
  if (!rude_U_c) {
    return;
  }

  switch (what) {
   case 1:                             /* not a number */
    *rude_Y_f = huge * huge - huge * huge;
    break;

   case 2:                             /* infinite */
    *rude_Y_f = huge * huge;
    break;

   case 3:
    *rude_Y_f = -huge * huge;
    break;

   case 4:                             /* far more than there is */
    *rude_Y_f = huge;
    break;

   case 5:                             /* pushes */
    *rude_Y_f = -huge;
    break;

   case 6:                             /* says that it failed */
    *rude_Y_f = 5.0;
    rude_M->errorStatus = "overrun";
    break;

   case 7:                             /* takes long */
    *rude_Y_f = 5.0;
    for (wait = 0.0; wait < 1.0E+8; wait += 1.0) {
    }
    break;

   case 8:                             /* after a while does not come back */
    for (wait = rude_U_t; wait > 1.5; wait += 1.0) {
    }
    break;

   case 9:                             /* 5 N by what some machines have no library for */
    *rude_Y_f = fabs(-sqrt(rude_U_k + 16.0));
    break;

   default:
    *rude_Y_f = 5.0;
    break;
  }
}

/* Model initialize function */
void rude_initialize(RT_MODEL_rude_T *const rude_M)
{
  (void)rude_M;
}

/* Model terminate function */
void rude_terminate(RT_MODEL_rude_T *const rude_M)
{
  (void)rude_M;
}

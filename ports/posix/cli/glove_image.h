/* The file that `exhand calibrate --glove` writes and others read. */
#ifndef CLI_GLOVE_IMAGE_H
#define CLI_GLOVE_IMAGE_H

#define IMAGE_NAME   "glove.bin"
#define IMAGE_WANTED IMAGE_NAME " that `exhand calibrate --glove --out` wrote"

#endif

#include "sim_controller/val3/program/signal_link.hpp"

#include <gtest/gtest.h>

namespace val3 {
namespace {

TEST(SignalLink, NamesAnInputByTheCardsOfAControllerAndByNoOther) {
  for (const char* link : {"BasicIO-1\\%I0", "ModbusSrv-0\\%IW12", "FastIO\\fIn1", "fIn0", "UserIO\\usrIn1",
                           "bIn15", "FastIO\\SECTEUR_OK", "BasicIO-12\\bIn3"})
    EXPECT_TRUE(names_input(link)) << link;
  for (const char* link : {"BasicIO-1\\%Q0", "FastIO\\fOut0", "bOut3", "valve1", "ModbusSrv-0\\Bits\\Ink",
                           "J206\\partIn1", "partIn1", "", "J206\\bIn3", "J206-1\\usrIn0",
                           "ModbusSrv-0\\SECTEUR_OK", "BasicIO-\\bIn1", "BasicIO-x\\bIn1", "\\bIn1"})
    EXPECT_FALSE(names_input(link)) << link;
}

}  // namespace
}  // namespace val3

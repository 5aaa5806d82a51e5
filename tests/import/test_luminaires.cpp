// Photometric files: what each says, in all the ways that it may be written, and what is wrong with it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/image_io.h"
#include "import/glb_builder.h"
#include "import/import.h"
#include "shared_data.h"

namespace heliodon {
namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

struct Reader {
    tests::TemporaryFolder folder;
    Warnings warnings;

    Result<std::shared_ptr<const Luminaire>> load(const std::string& text, const std::string& name = "l.ies",
                                                  int lamp_set = 1) {
        warnings.clear();
        return load_luminaire(folder.write(name, text), lamp_set, warnings);
    }
    Luminaire read(const std::string& text, const std::string& name = "l.ies", int lamp_set = 1) {
        const auto luminaire = load(text, name, lamp_set);
        if (!luminaire) ADD_FAILURE() << luminaire.error().text();
        return luminaire ? **luminaire : Luminaire{};
    }
    /// The message, from the file's name on.
    std::string error(const std::string& text, const std::string& name = "l.ies", int lamp_set = 1) {
        const auto luminaire = load(text, name, lamp_set);
        if (luminaire) return "no error";
        const std::string message = luminaire.error().text();
        return message.substr(message.find(name));
    }
    bool warned(std::string_view text) const {
        for (const Error& warning : warnings)
            if (warning.message.find(text) != std::string::npos) return true;
        return false;
    }
};

/// Intensity where C and γ are in degrees; between the file's own angles nothing is asked.
double candela(const Luminaire& luminaire, double c_deg, double gamma_deg) {
    const PhotometricWeb& web = luminaire.web;
    const auto find = [](const std::vector<double>& angles, double angle) {
        for (std::size_t i = 0; i < angles.size(); ++i)
            if (std::abs(angles[i] - angle * degree) < 1e-9) return i;
        ADD_FAILURE() << "no angle of " << angle;
        return std::size_t{0};
    };
    return web.at(web.azimuth_rad.size() == 1 ? 0 : find(web.azimuth_rad, c_deg), find(web.polar_rad, gamma_deg));
}

// -- the shared files

struct Known {
    const char* file;
    double flux_lm;   ///< or the share of the lamps' flux
    double lamps_lm;  ///< 1 where flux_lm is a flux
    double peak_cd;   ///< 0: not published
    const char* opening;
    bool contradicts_itself;
};
class SharedLuminaire : public testing::TestWithParam<Known> {};

TEST_P(SharedLuminaire, HasThePublishedFluxAndWarnsWhereItContradictsItself) {
    const Known& known = GetParam();
    const auto path = tests::shared_path(std::string("photometry/") + known.file);
    if (!path) GTEST_SKIP() << "needs the shared photometric files";
    Warnings warnings;
    const auto luminaire = load_luminaire(*path, 1, warnings);
    ASSERT_TRUE(luminaire) << luminaire.error().text();
    const double expected = known.flux_lm * known.lamps_lm;
    std::printf("             %.4f lm, %.5f of what is published\n", (*luminaire)->flux_lm,
                (*luminaire)->flux_lm / expected);
    EXPECT_NEAR((*luminaire)->flux_lm, expected, 0.001 * expected);
    if (known.peak_cd > 0) {
        EXPECT_NEAR((*luminaire)->peak_cd, known.peak_cd, 0.001 * known.peak_cd);
    }
    EXPECT_EQ(describe((*luminaire)->opening), known.opening);
    bool contradicts = false;
    for (const Error& warning : warnings) contradicts |= warning.message.find("intensities") != std::string::npos;
    EXPECT_EQ(contradicts, known.contradicts_itself) << (warnings.empty() ? "" : warnings.front().text());
}

INSTANTIATE_TEST_SUITE_P(Files, SharedLuminaire,
                         testing::Values(Known{"maxwell-8-led.ies", 999.9, 1, 424.7, "point", false},
                                         Known{"indoor-60w.ies", 5300.8, 1, 1917.1, "disc", false},
                                         Known{"ABSOLUTE_LED.ies", 5174.1, 1, 3500, "box", false},
                                         Known{"floor_uplight.ldt", 0.7266, 20000, 0, "disc", false},
                                         Known{"fluorescent_luminaire.ldt", 0.4028, 8100, 0, "rectangle", false},
                                         Known{"road_luminaire.ldt", 0.8414, 33200, 0, "cylinder", false},
                                         Known{"projector.ldt", 0.7935, 6500, 0, "rectangle", false},
                                         // Declares 90 %.
                                         Known{"wiki-spotlight.ldt", 0.767, 1500, 0, "point", true}),
                         [](const auto& info) {
                             std::string name = info.param.file;
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
                             return name;
                         });

TEST(Luminaires, TheTiltOfTheSharedFileIsAFactorOfTheWholeAndOfTwoLampSetsOneIsLit) {
    const auto tilted = tests::shared_path("photometry/TILT_TEST_SYNTHETIC.ies");
    const auto two = tests::shared_path("photometry/demo_two_lamp_sets.ldt");
    if (!tilted || !two) GTEST_SKIP() << "needs the shared photometric files";
    Warnings warnings;
    const auto luminaire = load_luminaire(*tilted, 1, warnings);
    ASSERT_TRUE(luminaire);
    EXPECT_DOUBLE_EQ((*luminaire)->factor_at_tilt(0), 1);
    EXPECT_DOUBLE_EQ((*luminaire)->factor_at_tilt(45 * degree), 0.9);
    EXPECT_NEAR((*luminaire)->factor_at_tilt(67.5 * degree), 0.85, 1e-12);
    EXPECT_EQ((*luminaire)->peak_cd, 1000);
    const auto first = load_luminaire(*two, 1, warnings), second = load_luminaire(*two, 2, warnings);
    ASSERT_TRUE(first && second);
    EXPECT_NEAR((*second)->flux_lm / (*first)->flux_lm, 10080.0 / 9408.0, 1e-9);
    const auto third = load_luminaire(*two, 3, warnings);
    ASSERT_FALSE(third);
    EXPECT_NE(third.error().text().find("expected 3 sets of lamps, for lamp_set 3, found 2"), std::string::npos)
        << third.error().text();
}

// -- IES

struct Ies {
    std::string first = "IESNA:LM-63-2002\n[TEST] none\n[LUMINAIRE] Downlight\nTILT=NONE\n";
    std::string counts = "1 1000 1 3 1 1 2";
    std::string opening = "0 0 0";
    std::string factors = "1 1 10";
    std::string vertical = "0 45 90";
    std::string horizontal = "0";
    std::string values = "100 80 40";

    [[nodiscard]] std::string text() const {
        return first + counts + " " + opening + "\n" + factors + "\n" + vertical + "\n" + horizontal + "\n" + values +
               "\n";
    }
};

TEST(Ies, OnePlaneIsTheSameAllRoundAndItsFluxIsTheIntegralOfStraightLines) {
    Reader reader;
    const Luminaire luminaire = reader.read(Ies{}.text());
    EXPECT_EQ(luminaire.name, "Downlight");
    EXPECT_EQ(luminaire.web.azimuth_rad.size(), 1u);
    // ∫ (a + bγ) sin γ = −(a + bγ) cos γ + b sin γ over the two steps.
    const double q = pi / 4, r = std::sqrt(0.5);
    const double first = 100 - 80 * r - 20 / q * r, second = 80 * r - 40 / q * (1 - r);
    EXPECT_NEAR(luminaire.flux_lm, 2 * pi * (first + second), 1e-9);
    EXPECT_TRUE(reader.warnings.empty());
}

TEST(Ies, PlanesAreCompletedByTheirLastAngle) {
    Reader reader;
    Ies ies;
    ies.counts = "1 1000 1 2 3 1 2";
    ies.vertical = "0 90";
    ies.values = "1 2  1 3  1 4";
    ies.horizontal = "0 45 90";
    Luminaire luminaire = reader.read(ies.text());
    for (const double c : {0.0, 180.0, 360.0}) EXPECT_EQ(candela(luminaire, c, 90), 2) << c;
    for (const double c : {45.0, 135.0, 225.0, 315.0}) EXPECT_EQ(candela(luminaire, c, 90), 3) << c;
    for (const double c : {90.0, 270.0}) EXPECT_EQ(candela(luminaire, c, 90), 4) << c;
    ies.horizontal = "0 60 180";
    luminaire = reader.read(ies.text());
    for (const double c : {60.0, 300.0}) EXPECT_EQ(candela(luminaire, c, 90), 3) << c;
    EXPECT_EQ(candela(luminaire, 180, 90), 4);
    ies.horizontal = "90 120 270";
    luminaire = reader.read(ies.text());
    for (const double c : {60.0, 120.0}) EXPECT_EQ(candela(luminaire, c, 90), 3) << c;
    EXPECT_EQ(candela(luminaire, 90, 90), 2);
    EXPECT_EQ(candela(luminaire, 270, 90), 4);
    EXPECT_EQ(reader.error(ies.text()), "no error");
    ies.horizontal = "0 120 360";
    luminaire = reader.read(ies.text());
    EXPECT_EQ(candela(luminaire, 120, 90), 3);
    EXPECT_EQ(candela(luminaire, 0, 90), 2);
    EXPECT_TRUE(reader.warnings.empty());
    ies.horizontal = "0 120 240";  // the plane at 360 left out
    luminaire = reader.read(ies.text());
    EXPECT_EQ(candela(luminaire, 240, 90), 4);
    EXPECT_EQ(candela(luminaire, 360, 90), 2);
    EXPECT_TRUE(reader.warned("closes the circle"));
}

TEST(Ies, TypesAAndBShineIntoOneHalfSpace) {
    Reader reader;
    Ies ies;
    ies.counts = "1 1000 1 3 2 3 2";  // type A
    ies.vertical = "-90 0 90";
    ies.horizontal = "0 90";
    ies.values = "1 5 1  1 2 1";
    const Luminaire a = reader.read(ies.text());
    EXPECT_EQ(a.web.axis, PhotometricWeb::Axis::vertical);
    EXPECT_EQ(candela(a, 0, 90), 5);          // photometric horizontal: C0, γ 90
    EXPECT_EQ(a.web.azimuth_rad.size(), 6u);  // 0 90 90 270 270 360
    ies.counts = "1 1000 1 3 2 2 2";
    const Luminaire b = reader.read(ies.text());
    EXPECT_EQ(b.web.axis, PhotometricWeb::Axis::horizontal);
    EXPECT_NEAR(b.flux_lm, a.flux_lm, 1e-9);
    // A constant over the half-space makes 2π of it.
    ies.values = "3 3 3  3 3 3";
    EXPECT_NEAR(reader.read(ies.text()).flux_lm, 2 * pi * 3, 1e-9);
    ies.horizontal = "-90 90";
    EXPECT_NEAR(reader.read(ies.text()).flux_lm, 2 * pi * 3, 1e-9);
    ies.horizontal = "0 60";
    EXPECT_EQ(reader.error(ies.text()),
              "l.ies:8: expected horizontal angles from 0 or -90 to 90 (type A or B), found 0 to 60");
}

TEST(Ies, MultiplierAndBallastFactorsScaleAsEachStandardHasThem) {
    Reader reader;
    Ies ies;
    ies.counts = "2 1000 3 3 1 1 2";
    ies.factors = "0.5 0.9 10";
    EXPECT_NEAR(reader.read(ies.text()).peak_cd, 150, 1e-9);
    ies.first = "IES:LM-63-2019\nTILT=NONE\n";
    EXPECT_NEAR(reader.read(ies.text()).peak_cd, 150, 1e-9);
    for (const char* old :
         {"IESNA:LM-63-1995\nTILT=NONE\n", "IESNA91\nTILT=NONE\n", "no standard named\nTILT=NONE\n"}) {
        ies.first = old;
        EXPECT_NEAR(reader.read(ies.text()).peak_cd, 135, 1e-9) << old;
    }
}

TEST(Ies, MoreLightThanTheLampsGiveIsDoubtedAndAbsolutePhotometryIsNot) {
    Reader reader;
    Ies ies;
    ies.counts = "1 100 1 3 1 1 2";
    (void)reader.read(ies.text());
    EXPECT_TRUE(reader.warned("more than the 100.0 lm"));
    ies.counts = "1 -1 1 3 1 1 2";
    (void)reader.read(ies.text());
    EXPECT_TRUE(reader.warnings.empty());
}

struct Opening {
    const char* first;
    const char* dimensions;
    const char* name;
    glm::vec3 size_m;  ///< along C0, up, across
};
class IesOpening : public testing::TestWithParam<Opening> {};

TEST_P(IesOpening, IsWhatItsStandardCodes) {
    Reader reader;
    Ies ies;
    ies.first = std::string(GetParam().first) + "\nTILT=NONE\n";
    ies.opening = GetParam().dimensions;
    const LuminousOpening opening = reader.read(ies.text()).opening;
    EXPECT_EQ(describe(opening), GetParam().name);
    EXPECT_EQ(opening.size_m, GetParam().size_m);
}

constexpr const char* y2002 = "IESNA:LM-63-2002";
constexpr const char* y1995 = "IESNA:LM-63-1995";
INSTANTIATE_TEST_SUITE_P(
    Codes, IesOpening,
    testing::Values(Opening{y2002, "0 0 0", "point", {0, 0, 0}}, Opening{y2002, "1 2 0", "rectangle", {2, 0, 1}},
                    Opening{y2002, "1 2 3", "box", {2, 3, 1}}, Opening{y2002, "-1 -1 0", "disc", {1, 0, 1}},
                    Opening{y2002, "-1 -2 0", "disc", {2, 0, 1}}, Opening{y2002, "-1 -1 3", "cylinder", {1, 3, 1}},
                    Opening{y2002, "-1 -1 -1", "sphere", {1, 1, 1}}, Opening{y2002, "-1 -2 -3", "ellipsoid", {2, 3, 1}},
                    Opening{y2002, "-1 5 -1", "cylinder", {5, 1, 1}}, Opening{y2002, "5 -1 -1", "cylinder", {1, 1, 5}},
                    Opening{y2002, "-1 0 -1", "disc", {0, 1, 1}}, Opening{y2002, "0 -1 -1", "disc", {1, 1, 0}},
                    Opening{y2002, "-1 0 0", "disc", {1, 0, 1}}, Opening{y1995, "-1 0 0", "disc", {1, 0, 1}},
                    Opening{y1995, "-1 0 2", "cylinder", {1, 2, 1}}, Opening{y1995, "-1 0 -1", "sphere", {1, 1, 1}},
                    Opening{y1995, "0 5 -1", "cylinder", {5, 1, 1}}, Opening{y1995, "5 0 -1", "cylinder", {1, 1, 5}},
                    Opening{y1995, "-1 2 0", "disc", {2, 0, 1}}, Opening{y2002, "0 3 0", "point", {0, 0, 0}}));

TEST(Ies, FeetAreConverted) {
    Reader reader;
    Ies ies;
    ies.counts = "1 1000 1 3 1 1 1";
    ies.opening = "1 2 0";
    const glm::vec3 size = reader.read(ies.text()).opening.size_m;
    EXPECT_FLOAT_EQ(size.x, 0.6096f);
    EXPECT_FLOAT_EQ(size.z, 0.3048f);
}

TEST(Ies, LineEndsSplitLinesCommasAndEncodingsMakeNoDifference) {
    Reader reader;
    const Ies ies;
    const Luminaire expected = reader.read(ies.text());
    const auto same = [&](const std::string& text, const char* what) {
        const Luminaire luminaire = reader.read(text);
        EXPECT_EQ(luminaire.web.candela, expected.web.candela) << what;
        EXPECT_EQ(luminaire.web.polar_rad, expected.web.polar_rad) << what;
    };
    const auto with_ends = [](const std::string& text, const std::string& end) {
        std::string result;
        for (const char c : text) result += c == '\n' ? end : std::string(1, c);
        return result;
    };
    same(with_ends(ies.text(), "\r\n"), "CR LF");
    same(with_ends(ies.text(), "\r"), "CR");
    same(ies.text() + "\x1a garbage after the end", "Ctrl-Z");
    same("\xef\xbb\xbf" + ies.text(), "UTF-8 mark");
    std::string wide = "\xff\xfe";
    for (const char c : ies.text()) wide += {c, '\0'};
    same(wide, "UTF-16");
    Ies other;
    other.first = "IESNA:LM-63-2002\n[MANUFAC] Interlight Ilumina\xe7\xe3o\n  tilt = none\n";
    other.counts = "1,1000,1,3,1,1,2,";
    other.vertical = "\n 0\n45.\n\n+9.0E1";
    other.values = "1.0d2,80\n,\t40";
    same(other.text(), "separators");
}

TEST(Ies, TheTiltOfTheLampMayStandInAFileBesideIt) {
    Reader reader;
    Ies ies;
    ies.first = "IESNA:LM-63-2002\nTILT=lamp.tlt\n";
    EXPECT_NE(reader.error(ies.text()).find("lamp.tlt"), std::string::npos);
    (void)reader.folder.write("lamp.tlt", "1\n3\n0 45 90\n1 .9 .7\n");
    EXPECT_DOUBLE_EQ(reader.read(ies.text()).factor_at_tilt(90 * degree), 0.7);
    (void)reader.folder.write("lamp.tlt", "1\n3\n0 45 90\n1 .9 x\n");
    const auto refused = reader.load(ies.text());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text().find("lamp.tlt:4: expected tilt factor 3 of 3, found \"x\""), std::string::npos);
}

struct Fault {
    const char* name;
    void (*spoil)(Ies&);
    const char* message;
};
class IesFault : public testing::TestWithParam<Fault> {};

TEST_P(IesFault, IsOneLocatedError) {
    Reader reader;
    Ies ies;
    GetParam().spoil(ies);
    EXPECT_EQ(reader.error(ies.text()), std::string("l.ies") + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, IesFault,
    testing::Values(Fault{"NoTilt", [](Ies& ies) { ies.first = "IESNA:LM-63-2002\n"; },
                          ":6: expected a line that begins with TILT=, found the end of the file"},
                    Fault{"Word", [](Ies& ies) { ies.values = "100 eighty 40"; },
                          ":9: expected intensity 2 of 3, found \"eighty\""},
                    Fault{"TooFew", [](Ies& ies) { ies.values = "100 80"; },
                          ":9: expected intensity 3 of 3, found the end of the file"},
                    Fault{"NotANumber", [](Ies& ies) { ies.values = "100 nan 40"; },
                          ":9: expected intensity 2 of 3, found \"nan\""},
                    Fault{"TooLarge", [](Ies& ies) { ies.values = "100 1e300 40"; },
                          ":9: expected intensity 2 of 3, found \"1e300\""},
                    Fault{"HugeCount", [](Ies& ies) { ies.counts = "1 1000 1 99999 1 1 2"; },
                          ":6: expected 99999 vertical angles, found fewer characters in the whole file"},
                    Fault{"FractionOfAnAngle", [](Ies& ies) { ies.counts = "1 1000 1 2.5 1 1 2"; },
                          ":5: expected the count of vertical angles (a whole number from 2 to 100000), found 2.5"},
                    Fault{"FallingAngles", [](Ies& ies) { ies.vertical = "0 90 45"; },
                          ":7: expected vertical angles that rise, found 45 after 90"},
                    Fault{"AnglesBeyondTheZenith", [](Ies& ies) { ies.vertical = "0 90 190"; },
                          ":7: expected vertical angles from 0 to 180, found 190"},
                    Fault{"NoMultiplier", [](Ies& ies) { ies.counts = "1 1000 0 3 1 1 2"; },
                          ":5: expected a multiplier of intensities above 0, found 0"},
                    Fault{"TypeFour", [](Ies& ies) { ies.counts = "1 1000 1 3 1 4 2"; },
                          ":5: expected the type of photometry (a whole number from 1 to 3), found 4"},
                    Fault{"Symmetry",
                          [](Ies& ies) {
                              ies.counts = "1 1000 1 3 2 1 2";
                              ies.horizontal = "0 70";
                              ies.values = "1 1 1 1 1 1";
                          },
                          ":8: expected horizontal angles that end at 0, 90, 180 or 360, found 70"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Ies, NegativeIntensitiesAreNoneAndWhatFollowsIsNotRead) {
    Reader reader;
    Ies ies;
    ies.values = "100 80 -1\n12";
    const Luminaire luminaire = reader.read(ies.text());
    EXPECT_EQ(candela(luminaire, 0, 90), 0);
    EXPECT_TRUE(reader.warned("1 intensities are negative"));
    EXPECT_TRUE(reader.warned("more follows"));
    ies.vertical = "0 45 85";
    (void)reader.read(ies.text());
    EXPECT_TRUE(reader.warned("run from 0 to 85: no light is sent outside them"));
}

// -- EULUMDAT

struct Ldt {
    int symmetry = 1, planes = 1, angles = 3;
    std::string area = "0\n0\n0\n0\n0\n0\n";  // length, width, four heights
    std::string ratios = "100\n0\n1\n0\n";    // downwards, output, conversion, tilt
    std::string lamps = "1\n1\nLED\n2000\n3000K\n1A\n20\n";
    std::string c = "0\n";
    std::string gamma = "0\n45\n90\n";
    std::string values = "100\n80\n40\n";

    [[nodiscard]] std::string text() const {
        return "Maker\n1\n" + std::to_string(symmetry) + "\n" + std::to_string(planes) + "\n0\n" +
               std::to_string(angles) + "\n0\nreport\nname\nnumber\nfile\ndate\n100\n100\n50\n" + area + ratios +
               lamps + "0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n" + c + gamma + values;
    }
    static Ldt of(int symmetry, int planes) {
        Ldt ldt;
        ldt.symmetry = symmetry;
        ldt.planes = planes;
        ldt.angles = 2;
        ldt.gamma = "0\n90\n";
        ldt.c = ldt.values = "";
        for (int i = 0; i < planes; ++i) ldt.c += std::to_string(i * 360 / planes) + "\n";
        return ldt;
    }
};

TEST(Eulumdat, IntensitiesAreForAThousandLumenOfTheLamps) {
    Reader reader;
    Ldt ldt;
    EXPECT_NEAR(reader.read(ldt.text(), "l.ldt").peak_cd, 200, 1e-9);
    ldt.ratios = "100\n0\n0,5\n0\n";  // a conversion factor, with a decimal comma
    EXPECT_NEAR(reader.read(ldt.text(), "l.ldt").peak_cd, 100, 1e-9);
    ldt.lamps = "1\n-1\nLED\n2000\n3000K\n1A\n20\n";  // absolute photometry
    EXPECT_NEAR(reader.read(ldt.text(), "l.ldt").peak_cd, 100, 1e-9);
    ldt.lamps = "2\n1\nLED\n2000\n\n\n20\n3\nLED\n8000\n\n\n80\n";
    EXPECT_NEAR(reader.read(ldt.text(), "l.ldt", 2).peak_cd, 400, 1e-9);
    EXPECT_TRUE(reader.warned("has 2 sets of lamps: number 2 is lit"));
}

TEST(Eulumdat, EverySymmetryGivesThePlanesThatItStandsFor) {
    Reader reader;
    Ldt ldt = Ldt::of(0, 4);
    ldt.values = "1 10\n1 20\n1 30\n1 40\n";
    Luminaire luminaire = reader.read(ldt.text(), "l.ldt");
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(candela(luminaire, 90 * i, 90), 20 * (i + 1), 1e-9);
    ldt = Ldt::of(2, 4);
    ldt.values = "1 10\n1 20\n1 30\n";
    luminaire = reader.read(ldt.text(), "l.ldt");
    for (const auto& [c, value] : {std::pair{0, 20}, {90, 40}, {180, 60}, {270, 40}})
        EXPECT_NEAR(candela(luminaire, c, 90), value, 1e-9) << c;
    ldt = Ldt::of(3, 4);  // begins at C270
    luminaire = reader.read(ldt.text() + "1 10\n1 20\n1 30\n", "l.ldt");
    for (const auto& [c, value] : {std::pair{270, 20}, {0, 40}, {90, 60}, {180, 40}})
        EXPECT_NEAR(candela(luminaire, c, 90), value, 1e-9) << c;
    ldt = Ldt::of(4, 8);
    luminaire = reader.read(ldt.text() + "1 10\n1 20\n1 30\n", "l.ldt");
    for (const auto& [c, value] :
         {std::pair{0, 20}, {45, 40}, {90, 60}, {135, 40}, {180, 20}, {225, 40}, {270, 60}, {315, 40}})
        EXPECT_NEAR(candela(luminaire, c, 90), value, 1e-9) << c;
}

TEST(Eulumdat, LengthLiesAlongC90AndNoWidthMeansRound) {
    Reader reader;
    Ldt ldt;
    const auto opening = [&](const char* area) {
        ldt.area = area;
        return reader.read(ldt.text(), "l.ldt").opening;
    };
    EXPECT_EQ(describe(opening("1200\n200\n0\n0\n0\n0\n")), "rectangle");
    EXPECT_EQ(opening("1200\n200\n0\n0\n0\n0\n").size_m, glm::vec3(0.2f, 0, 1.2f));
    EXPECT_EQ(describe(opening("300\n0\n0\n0\n0\n0\n")), "disc");
    EXPECT_EQ(describe(opening("300\n0\n50\n50\n50\n50\n")), "cylinder");
    EXPECT_EQ(opening("300\n100\n50\n50\n50\n80\n").size_m, glm::vec3(0.1f, 0.08f, 0.3f));
    EXPECT_TRUE(reader.warned("taken as the highest"));
    EXPECT_EQ(describe(opening("0\n0\n0\n0\n0\n0\n")), "point");
}

TEST(Eulumdat, WhatItDeclaresAgainstItsIntensitiesIsDoubted) {
    Reader reader;
    Ldt ldt;
    ldt.ratios = "100\n90\n1\n0\n";
    (void)reader.read(ldt.text(), "l.ldt");
    EXPECT_TRUE(reader.warned("declares a light output ratio of 90 %"));
    ldt.ratios = "60\n0\n1\n0\n";
    (void)reader.read(ldt.text(), "l.ldt");
    EXPECT_TRUE(reader.warned("declares 60 % of its light downwards, its intensities send 100.0 % there"));
    ldt.lamps = "0\n";
    ldt.ratios = "100\n0\n1\n0\n";
    (void)reader.read(ldt.text(), "l.ldt");
    EXPECT_TRUE(reader.warned("names no lamps"));
}

TEST(Eulumdat, FaultsAreLocated) {
    Reader reader;
    const auto error = [&](auto&& spoil) {
        Ldt ldt = Ldt::of(2, 4);
        ldt.values = "1\n2\n1\n2\n1\n2\n";
        spoil(ldt);
        return reader.error(ldt.text(), "l.ldt");
    };
    EXPECT_EQ(error([](Ldt&) {}), "no error");
    EXPECT_EQ(error([](Ldt& l) { l.symmetry = 5; }),
              "l.ldt:3: expected the symmetry (a whole number from 0 to 4), found 5");
    EXPECT_EQ(error([](Ldt& l) { l.planes = 0; }),
              "l.ldt:4: expected the number of C-planes (a whole number from 1 to 10000), found 0");
    EXPECT_EQ(error([](Ldt& l) { l.area = "-1\n0\n0\n0\n0\n0\n"; }),
              "l.ldt:16: expected the luminous area's length of at least 0, found -1");
    EXPECT_EQ(error([](Ldt& l) { l.lamps = "1\n1\nLED\nmany\n\n\n\n"; }),
              "l.ldt:29: expected the lamps' flux, found \"many\"");
    EXPECT_EQ(error([](Ldt& l) { l.lamps = "1\n1\nLED\n0\n\n\n\n"; }),
              "l.ldt:29: expected a flux of lamps above 0, found 0");
    EXPECT_EQ(error([](Ldt& l) { l.c = "0\n90\n170\n270\n"; }),
              "l.ldt:46: expected C180 as plane 3 of 4 (symmetry 2), found C170");
    EXPECT_EQ(error([](Ldt& l) { l.gamma = "0\n0\n"; }), "l.ldt:48: expected gamma angles that rise, found 0 after 0");
    EXPECT_EQ(error([](Ldt& l) { l.values = "1\n2\n1\n2\n1\n"; }),
              "l.ldt:53: expected intensity 6 of 6, found the end of the file");
    EXPECT_EQ(reader.error("", "l.ldt"), "l.ldt:1: expected the manufacturer, found the end of the file");
}

TEST(Luminaires, TheContentDecidesWhereTheEndingDoesNot) {
    Reader reader;
    EXPECT_EQ(reader.read(Ies{}.text(), "l.txt").name, "Downlight");
    EXPECT_EQ(reader.read(Ies{}.text(), "l.ldt").name, "Downlight");
    EXPECT_EQ(reader.read(Ldt{}.text(), "l.txt").name, "name");
    EXPECT_NE(reader.error(Ies{}.text(), "l.ies", 2).find("expected lamp_set 1"), std::string::npos);
}

TEST(Luminaires, AreModelsOfOneLight) {
    Reader reader;
    Scene scene;
    Warnings warnings;
    const auto root = import_model(scene, {}, reader.folder.write("down.IES", Ies{}.text()), warnings);
    ASSERT_TRUE(root) << root.error().text();
    const Node& node = *scene.nodes().find(*root);
    EXPECT_EQ(node.name, "down");
    ASSERT_TRUE(node.light && node.light->luminaire);
    EXPECT_NEAR(flux_lm(*node.light), node.light->luminaire->flux_lm, 1e-3);
    EXPECT_FALSE(import_model(scene, {}, reader.folder.write("cut.ldt", "Maker\n"), warnings));
    EXPECT_EQ(scene.nodes().size(), 1u);
}

TEST(Luminaires, CutOrDamagedAnywhereTheyAreRefusedOrRead) {
    Reader reader;
    std::mt19937 random(7);
    Ies ies;
    ies.first = "IESNA:LM-63-2002\nTILT=INCLUDE\n1\n2\n0 90\n1 .5\n";
    ies.opening = "-.2 -.2 0";
    int read = 0;
    for (const auto& [name, text] :
         {std::pair<std::string, std::string>{"l.ies", ies.text()}, {"l.ldt", Ldt{}.text()}}) {
        const auto look = [&](const std::string& bytes) {
            const auto luminaire = reader.load(bytes, name);
            if (!luminaire) {
                EXPECT_NE(luminaire.error().where.find(name), std::string::npos) << luminaire.error().text();
                return;
            }
            ++read;
            EXPECT_TRUE(std::isfinite((*luminaire)->flux_lm)) << bytes;
            EXPECT_GE((*luminaire)->flux_lm, 0) << bytes;
        };
        for (std::size_t length = 0; length < text.size(); ++length) look(text.substr(0, length));
        for (int i = 0; i < 400; ++i) {
            std::string bytes = text;
            for (int k = 0; k < 1 + i % 3; ++k) bytes[random() % bytes.size()] = "0123456789.-e, \n\xff"[random() % 17];
            look(bytes);
        }
    }
    EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace heliodon

// Curves of pbrt's format against what one can calculate: tubes and ribbons where and as large as they should be.
#include "core/statistics.h"
#include "sampling/paths/path_tracer.h"
#include "scene/geometry.h"
#include "support/chance.h"
#include "support/pbrt_scenes.h"

#include <Imath/ImathBox.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string curve(const std::string& parameters) { return "Shape \"curve\" " + parameters + "\n"; }

/// A straight strand along x from 0 to 3.
const std::string kStraight = "\"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] ";
const std::string kBow = "\"point3 P\" [ 0 0 0  0 1 0  1 1 0  1 0 0 ] ";
const std::string kTube = "\"string type\" \"cylinder\" ";

Imath::Box3f box_of(const TriangleMesh& mesh) {
    Imath::Box3f box;
    for (const Vec3& p : mesh.positions) box.extendBy(p);
    return box;
}

void expect_box(const TriangleMesh& mesh, const Vec3& low, const Vec3& high, float tolerance) {
    const Imath::Box3f box = box_of(mesh);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(box.min[axis], low[axis], tolerance) << axis;
        EXPECT_NEAR(box.max[axis], high[axis], tolerance) << axis;
    }
}

/// The mean of as many corners: the middle of the first or the last ring.
Vec3 mean_of_ends(const TriangleMesh& mesh, bool last, std::size_t corners) {
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < corners; ++i) sum += mesh.positions.at(last ? mesh.positions.size() - 1 - i : i);
    return sum / static_cast<float>(corners);
}

/// Of a ring of a tube of that width: the positions that stand together at the begin.
std::size_t corners_of(const TriangleMesh& mesh, float width) {
    const auto end = std::find_if(mesh.positions.begin(), mesh.positions.end(),
                                  [&](const Vec3& p) { return (p - mesh.positions.front()).length() > 1.5f * width; });
    return static_cast<std::size_t>(end - mesh.positions.begin());
}

Vec3 geometric_normal(const TriangleMesh& mesh, std::size_t i) {
    const auto& t = mesh.triangles.at(i);
    const auto& x = mesh.positions;
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
}

TEST(PbrtCurves, StraightTubesHaveTheAreaOfACylinder) {
    for (const double width : {0.002, 0.1, 1.0}) {
        const PbrtScene s(curve(kTube + kStraight + fmt::format("\"float width\" {}", width)));
        EXPECT_NEAR(surface_area(s.shape()) / (kPi * width * 3), 1, 1e-5) << width;
        const float r = static_cast<float>(width) / 2;
        expect_box(s.mesh(), {0, -r, -r}, {3, r, r}, 0.12f * r);
        EXPECT_THAT(s.warnings, IsEmpty());
    }
}

TEST(PbrtCurves, StraightStrandsAreCheap) {
    const PbrtScene thin(curve(kTube + kStraight + "\"float width\" 0.001"));
    EXPECT_LE(thin.mesh().triangles.size(), 12u);
    EXPECT_TRUE(thin.mesh().uvs.empty()) << "nothing reads them";
    const PbrtScene uneven(curve(kTube + "\"float width\" 0.001 \"point3 P\" [ 0 0 0  0.1 0 0  0.2 0 0  3 0 0 ]"));
    EXPECT_EQ(uneven.mesh().triangles.size(), thin.mesh().triangles.size());
    const PbrtScene bow(curve(kTube + kBow + "\"float width\" 0.001"));
    EXPECT_GT(bow.mesh().triangles.size(), 4 * thin.mesh().triangles.size());
    EXPECT_LT(bow.mesh().triangles.size(), 50 * thin.mesh().triangles.size());
    const PbrtScene thick(curve(kTube + kStraight));
    EXPECT_GT(thick.mesh().triangles.size(), 40u);
}

TEST(PbrtCurves, TaperToTheirWidths) {
    // The area of a cone: pi r s.
    const PbrtScene cone(curve(kTube + kStraight + "\"float width0\" 1 \"float width1\" 0"));
    EXPECT_NEAR(surface_area(cone.shape()) / (kPi * 0.5 * std::hypot(3, 0.5)), 1, 2e-3);
    const TriangleMesh& mesh = cone.mesh();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3 n = geometric_normal(mesh, i);
        EXPECT_NEAR(n.x, 0.5 / std::hypot(3, 0.5), 2e-3);
        for (const auto k : mesh.triangles[i]) EXPECT_GT(n.dot(mesh.normals[k]), 0.9f);
    }
    const PbrtScene both(curve(kTube + kStraight + "\"float width\" 1 \"float width1\" 0.5"));
    EXPECT_NEAR(surface_area(both.shape()) / (kPi * 0.75 * std::hypot(3, 0.25)), 1, 2e-3);
}

TEST(PbrtCurves, FaceOutwards) {
    const PbrtScene s(curve(kTube + kBow + "\"float width\" 0.1"));
    const TriangleMesh& mesh = s.mesh();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const auto k : mesh.triangles[i]) EXPECT_GT(geometric_normal(mesh, i).dot(mesh.normals[k]), 0.6f);
    // The tube's normals point away from its axis, which lies within the unit square.
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (mesh.positions[i].x < -0.045f) {
            EXPECT_LT(mesh.normals[i].x, -0.7f);
        }
}

/// Bezier curves go through their first and last point; the length is that of the curve.
TEST(PbrtCurves, BezierOnesRunWhereTheirPointsSay) {
    const PbrtScene s(curve(kTube + kBow + "\"float width\" 0.001"));
    const std::size_t corners = corners_of(s.mesh(), 0.001f);
    EXPECT_LT((mean_of_ends(s.mesh(), false, corners) - Vec3(0, 0, 0)).length(), 1e-6f);
    EXPECT_LT((mean_of_ends(s.mesh(), true, corners) - Vec3(1, 0, 0)).length(), 1e-6f);
    EXPECT_NEAR(surface_area(s.shape()) / (kPi * 0.001), 2.0, 4e-3) << "the length of this curve is 2";
    EXPECT_NEAR(box_of(s.mesh()).max.y, 0.75, 2e-3) << "the top of the bow";
    // A parabola of degree 2: y = x (2 - x) / 2 over [0, 2].
    const PbrtScene parabola(
        curve(kTube + "\"integer degree\" 2 \"float width\" 0.001 \"point3 P\" [ 0 0 0  1 1 0  2 0 0 ]"));
    EXPECT_NEAR(box_of(parabola.mesh()).max.y, 0.5, 2e-3);
    const double length = std::sqrt(2) + std::asinh(1); // of twice the integral of sqrt(1 + y'^2) over [0, 1]
    EXPECT_NEAR(surface_area(parabola.shape()) / (kPi * 0.001), length, 4e-3);
}

TEST(PbrtCurves, SegmentsFollowOneAnother) {
    const PbrtScene one(curve(kTube + kStraight + "\"float width\" 0.01"));
    const PbrtScene two(curve(kTube + "\"float width\" 0.01 \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0  4 0 0  5 0 0 "
                                      "6 0 0 ] \"float width1\" 0.03"));
    EXPECT_NEAR(surface_area(two.shape()), 6 * kPi * 0.02, 2e-4) << "widths go from end to end";
    EXPECT_LE(two.mesh().triangles.size(), 3 * one.mesh().triangles.size());
    // A corner stays as thick as the rest.
    const PbrtScene corner(curve(kTube + "\"integer degree\" 2 \"float width\" 0.2 \"point3 P\" [ 0 0 0  1 0 0  2 0 0  "
                                         "2 1 0  2 2 0 ]"));
    EXPECT_NEAR(surface_area(corner.shape()), 4 * kPi * 0.2, 1e-3);
}

/// Uniform B-splines begin at (a + 4 b + c) / 6 where cubic, at (a + b) / 2 where quadratic.
TEST(PbrtCurves, SplinesRunWhereTheirPointsSay) {
    const std::string points = "\"float width\" 0.001 \"point3 P\" [ 0 0 0  0 6 0  6 6 0  6 0 0  12 0 6 ] ";
    const PbrtScene cubic(curve(kTube + "\"string basis\" \"bspline\" " + points));
    const std::size_t first = corners_of(cubic.mesh(), 0.001f);
    EXPECT_LT((mean_of_ends(cubic.mesh(), false, first) - Vec3(1, 5, 0)).length(), 1e-5f);
    EXPECT_LT((mean_of_ends(cubic.mesh(), true, first) - Vec3(7, 1, 1)).length(), 1e-5f);
    const PbrtScene quadratic(curve(kTube + "\"integer degree\" 2 \"string basis\" \"bspline\" " + points));
    const std::size_t corners = corners_of(quadratic.mesh(), 0.001f);
    EXPECT_LT((mean_of_ends(quadratic.mesh(), false, corners) - Vec3(0, 3, 0)).length(), 1e-5f);
    EXPECT_LT((mean_of_ends(quadratic.mesh(), true, corners) - Vec3(9, 0, 3)).length(), 1e-5f);
}

TEST(PbrtCurves, RibbonsTurnFromNormalToNormal) {
    const std::string ribbon = "\"string type\" \"ribbon\" \"float width\" 0.5 ";
    const PbrtScene flat(curve(ribbon + kStraight + "\"normal N\" [ 0 0 1  0 0 2 ]"));
    EXPECT_EQ(flat.mesh().triangles.size(), 2u);
    EXPECT_NEAR(surface_area(flat.shape()), 1.5, 1e-6);
    expect_box(flat.mesh(), {0, -0.25f, 0}, {3, 0.25f, 0}, 1e-6f);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_GT(geometric_normal(flat.mesh(), i).z, 0.999f);
    for (const Vec3& n : flat.mesh().normals) EXPECT_GT(n.z, 0.999f);
    const PbrtScene turned(curve(ribbon + kStraight + "\"normal N\" [ 0 0 1  0 1 0 ]"));
    EXPECT_GT(turned.mesh().normals.front().z, 0.999f);
    EXPECT_GT(turned.mesh().normals.back().y, 0.999f);
    for (std::size_t i = 0; i < turned.mesh().positions.size(); ++i) {
        const Vec3& p = turned.mesh().positions[i];
        const double angle = kPi / 2 * static_cast<double>(p.x) / 3;
        EXPECT_NEAR(turned.mesh().normals[i].y, std::sin(angle), 1e-5) << p.x;
        EXPECT_NEAR(std::hypot(p.y, p.z), 0.25, 1e-5);
        EXPECT_NEAR(p.y * turned.mesh().normals[i].y + p.z * turned.mesh().normals[i].z, 0, 1e-5);
    }
    EXPECT_THAT(turned.warnings, IsEmpty());
}

TEST(PbrtCurves, FlatOnesBecomeTubesWhichIsSaid) {
    const PbrtScene s(curve(kStraight + "\"float width\" 0.1 \"integer splitdepth\" 3") +
                      curve(kStraight + "\"float width\" 0.1 \"string type\" \"flat\""));
    EXPECT_NEAR(surface_area(s.shape()), 2 * kPi * 0.1 * 3, 1e-4);
    EXPECT_THAT(s.warnings, ElementsAre(HasSubstr("scene.pbrt:4:1: Shape \"curve\": curves of type 'flat', which turn "
                                                  "towards whoever looks, become tubes")));
    EXPECT_THAT(PbrtScene(curve(kTube + kStraight + "\"normal N\" [ 0 0 1 0 0 1 ]")).warnings,
                ElementsAre(HasSubstr("'N' is ignored: only curves of type 'ribbon' have normals")));
}

TEST(PbrtCurves, ThatLookAlikeAreOneMesh) {
    const std::string thin = curve(kTube + kStraight + "\"float width\" 0.001");
    const std::string bow = curve(kTube + kBow + "\"float width\" 0.01 \"float alpha\" 1");
    const PbrtScene one(thin);
    const auto shapes = [](const std::string& world) { return PbrtScene(world).scene.description.shapes.size(); };
    const PbrtScene three(thin + "AttributeBegin " + thin + "AttributeEnd " + thin);
    ASSERT_EQ(three.scene.description.shapes.size(), 1u);
    EXPECT_NEAR(surface_area(three.shape()), 3 * surface_area(one.shape()), 1e-7);
    EXPECT_EQ(shapes(thin + "Material \"diffuse\" " + thin), 2u);
    EXPECT_EQ(shapes(thin + "Translate 0 0 1 " + thin), 2u);
    EXPECT_EQ(shapes(thin + "ReverseOrientation " + thin), 2u);
    EXPECT_EQ(shapes(thin + kPbrtTriangle + thin), 3u);
    EXPECT_EQ(shapes(thin + bow + bow), 2u) << "alpha";
    EXPECT_EQ(
        shapes(thin + "NamedMaterial \"m\" " + thin + thin + "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" "),
        2u);
    EXPECT_EQ(shapes("AreaLightSource \"diffuse\" " + thin + thin), 2u);
    const std::string medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ] \"rgb "
                               "sigma_s\" [ 0 0 0 ] MediumInterface \"m\" \"\" ";
    EXPECT_EQ(shapes(thin + medium + thin + thin), 2u);
}

TEST(PbrtCurves, OfAnObjectStayInIt) {
    const std::string thin = curve(kTube + kStraight + "\"float width\" 0.01");
    const PbrtScene s("ObjectBegin \"o\" " + thin + thin + "ObjectEnd ObjectInstance \"o\" " + thin +
                      "Translate 0 0 5 ObjectInstance \"o\" " + thin);
    std::vector<std::size_t> triangles;
    for (std::size_t i = 0; i < s.scene.description.shapes.size(); ++i) triangles.push_back(s.mesh(i).triangles.size());
    ASSERT_EQ(triangles.size(), 4u);
    EXPECT_EQ(triangles[0], 2 * triangles[1]);
    EXPECT_EQ(triangles[2], triangles[0]);
    EXPECT_EQ(triangles[3], triangles[1]);
    EXPECT_NEAR(box_of(s.mesh(2)).min.z, 5, 0.01);
}

TEST(PbrtCurves, HaveTextureCoordinatesWhereTheyAreRead) {
    const std::string textured = "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"diffuse\" \"texture "
                                 "reflectance\" \"t\" ";
    const PbrtScene tube(textured + curve(kTube + "\"integer degree\" 2 \"float width\" 0.01 \"point3 P\" [ 0 0 0  "
                                                  "1 0 0  2 0 0  3 0 0  4 0 0 ]"));
    const TriangleMesh& mesh = tube.mesh();
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    bool half = false;
    for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
        const float u = mesh.positions[i].x / 2; // from 0 to 1 along either segment
        EXPECT_TRUE(std::abs(mesh.uvs[i].x - u) < 1e-5f || std::abs(mesh.uvs[i].x - (u - 1)) < 1e-5f);
        half = half || mesh.uvs[i].y == 1;
    }
    EXPECT_TRUE(half) << "v goes from 0 to 1 around half of it";
    const PbrtScene ribbon(textured +
                           curve("\"string type\" \"ribbon\" " + kStraight + "\"normal N\" [ 0 0 1 0 0 1 ]"));
    for (std::size_t i = 0; i < 4; ++i) // v increases along N x dp/du
        EXPECT_NEAR(ribbon.mesh().uvs.at(i).y, ribbon.mesh().positions.at(i).y + 0.5f, 1e-6);
}

TEST(PbrtCurves, WithoutLengthAreLeftOut) {
    const std::string point = curve(kTube + "\"point3 P\" [ 1 0 0  1 0 0  1 0 0  1 0 0 ]");
    const PbrtScene s(point + kPbrtTriangle);
    EXPECT_EQ(s.scene.description.shapes.size(), 1u);
    EXPECT_THAT(s.warnings, ElementsAre(HasSubstr(":4:1: Shape \"curve\": no triangle of the mesh has an area")));
    const PbrtScene among(curve(kTube + kStraight) + point);
    EXPECT_EQ(among.mesh().triangles.size(), PbrtScene(curve(kTube + kStraight)).mesh().triangles.size());
    // Points that coincide at the ends are no matter, nor a curve that turns back.
    for (const char* points : {"0 0 0  0 0 0  3 1 0  3 0 0", "0 0 0  1 1 0  3 0 0  3 0 0",
                               "0 0 0  3 0 0  -1 0 0  1 0 0", "0 0 0  1 0 0  1 0 0  0 0 0"}) {
        const PbrtScene odd(curve(kTube + "\"float width\" 0.01 \"point3 P\" [ " + points + " ]"));
        for (const Vec3& p : odd.mesh().positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << points;
        for (const Vec3& n : odd.mesh().normals) EXPECT_NEAR(n.length(), 1, 1e-4) << points;
        EXPECT_GT(surface_area(odd.shape()), 0.01) << points;
    }
}

TEST(PbrtCurves, SayWhatIsWrong) {
    const auto wrong = [](const std::string& parameters) {
        return pbrt_error(kPbrtTriangle + "\n" + curve(parameters));
    };
    EXPECT_THAT(wrong(""), HasSubstr("scene.pbrt:6:1: Shape \"curve\": found no 'P', expected the points of a curve"));
    EXPECT_THAT(wrong("\"point3 P\" [ 0 0 0 1 1 1 2 2 2 ]"),
                HasSubstr("scene.pbrt:6:15: Shape \"curve\": found 3 points in 'P', expected 4, and 3 for each further "
                          "segment of a Bezier curve of that degree"));
    EXPECT_THAT(wrong("\"point3 P\" [ 0 0 0 1 1 1 2 2 2 3 3 3 4 4 4 ]"),
                HasSubstr("found 5 points in 'P', expected 4"));
    EXPECT_THAT(wrong("\"string basis\" \"bspline\" \"point3 P\" [ 0 0 0 1 1 1 2 2 2 ]"),
                HasSubstr("found 3 points in 'P', expected 4 or more for a B-spline of that degree"));
    EXPECT_THAT(wrong("\"integer degree\" 4 " + kStraight),
                HasSubstr("found 4 as 'degree', expected a whole number from 2"));
    EXPECT_THAT(wrong("\"float width\" -1 " + kStraight),
                HasSubstr("scene.pbrt:6:15: Shape \"curve\": found -1 as 'width'"));
    EXPECT_THAT(wrong("\"float width1\" -1 " + kStraight), HasSubstr("found -1 as 'width1', expected a number from 0"));
    EXPECT_THAT(wrong("\"point3 P\" [ 0 0 0 1 nan 1 2 2 2 3 3 3 ]"), HasSubstr("scene.pbrt:6:"));
    EXPECT_THAT(wrong("\"point3 P\" [ 0 0 0 1 1e20 1 2 2 2 3 3 3 ]"),
                HasSubstr("scene.pbrt:6:15: Shape \"curve\": found 1e+20 in 'P', expected a coordinate within 1e12"));
    EXPECT_THAT(
        wrong("\"string basis\" \"nurbs\" " + kStraight),
        HasSubstr("scene.pbrt:6:15: Shape \"curve\": found 'nurbs' as 'basis', expected one of bezier, bspline"));
    EXPECT_THAT(wrong("\"string type\" \"cylindre\" " + kStraight), HasSubstr("did you mean 'cylinder'?"));
    const std::string ribbon = "\"string type\" \"ribbon\" " + kStraight;
    EXPECT_THAT(wrong(ribbon), HasSubstr("scene.pbrt:6:1: Shape \"curve\": found 0 normals in 'N', expected 2 "
                                         "of a ribbon: one where each segment begins, and one at the end"));
    EXPECT_THAT(wrong(ribbon + "\"normal N\" [ 0 0 1 0 0 0 ]"),
                HasSubstr("found a normal 0 0 0, expected one with a length"));
}

/// Radiance that arrives at the eye along a path.
struct PathSum {
    double value = 0;
    bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*length*/) const { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*end*/, const Rgb& v, LightClass /*kind*/) {
        value += luminance(v);
    }
};

/// Mean radiance that the eye sees of a diffuse tube of albedo 0.6 and width 2 that fills its view, under a white sky.
RunningStats tube_under_a_white_sky(double length) {
    PbrtScene s(
        "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.6 0.6 ] " +
            curve(kTube + fmt::format("\"point3 P\" [ {} 0 0  {} 0 0  {} 0 0  {} 0 0 ] \"float width\" 2", -length / 2,
                                      -length / 6, length / 6, length / 2)),
        "LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20");
    const Scene scene(std::move(s.scene.description));
    RunningStats stats;
    Rng rng(6, StreamPurpose::test, 0);
    for (int i = 0; i < 20'000; ++i) {
        PathSum sum;
        const auto x = static_cast<float>(rng.next()), y = static_cast<float>(rng.next());
        trace_path(scene, {x, y}, 20, rng, sum);
        stats.add(sum.value);
    }
    EXPECT_LT(stats.standard_error(), 0.002);
    return stats;
}

/// It is convex, and looks as its albedo. Light from between a facet and the plane of its shading normal is lost.
TEST(PbrtCurves, ADiffuseTubeUnderAWhiteSkyIsAsBrightAsItsAlbedo) {
    const RunningStats thick = tube_under_a_white_sky(18), thin = tube_under_a_white_sky(1000);
    EXPECT_NEAR(thick.mean(), 0.6, 0.6 * 0.003 + 4 * thick.standard_error());
    EXPECT_NEAR(thin.mean(), 0.6 * 0.957, 0.6 * 0.003 + 4 * thin.standard_error());
}

} // namespace
} // namespace keyhole

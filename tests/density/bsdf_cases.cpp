#include "bsdf_cases.h"

namespace keyhole::test {
namespace {

const ComplexIndex kGold{Rgb(0.14, 0.37, 1.44), Rgb(3.98, 2.38, 1.60)};
/// Reflects all but 1e-4.
const ComplexIndex kWhite{Rgb(1.0), Rgb(200.0)};

std::vector<BsdfCase> make_cases() {
    static const auto coat = CoatInterface::of(1.5);
    const Rgb white(1.0);
    std::vector<BsdfCase> c;
    c.push_back({"diffuse", DiffuseBsdf{white}, 1, true, true});
    c.push_back({"diffuse_transmission", DiffuseTransmissionBsdf{Rgb(0.7), Rgb(0.3)}, 1, true, true});
    c.push_back({"diffuse_transmission_coloured", DiffuseTransmissionBsdf{Rgb(0.1, 0.5, 0.2), Rgb(0.6, 0.1, 0.2)}, 1,
                 false, true, 2.0});
    c.push_back({"mirror", MirrorBsdf{white}, 1, true, true});
    c.push_back({"conductor", ConductorBsdf{kGold}, 1, false, true});
    for (const float alpha : {0.05f, 0.3f, 1.0f})
        c.push_back({"rough_conductor_" + std::to_string(alpha), RoughConductorBsdf{kWhite, alpha, alpha}});
    c.push_back({"rough_conductor_anisotropic", RoughConductorBsdf{kGold, 0.1f, 0.5f}});
    c.push_back({"glass", GlassBsdf{1.5}, 1.5, true, true});
    c.push_back({"bubble", GlassBsdf{1 / 1.33}, 1 / 1.33, true, true});
    for (const float alpha : {0.1f, 0.4f, 1.0f})
        c.push_back({"rough_dielectric_" + std::to_string(alpha), RoughDielectricBsdf{1.5f, alpha, alpha}, 1.5});
    c.push_back({"rough_dielectric_anisotropic", RoughDielectricBsdf{1.8f, 0.15f, 0.6f}, 1.8});
    c.push_back({"rough_bubble", RoughDielectricBsdf{0.75f, 0.3f, 0.3f}, 0.75});
    c.push_back({"thin_dielectric", ThinDielectricBsdf{1.5}, 1, true, true});
    c.push_back({"interface", InterfaceBsdf{}, 1, true, true});
    c.push_back({"coated_diffuse", CoatedDiffuseBsdf(*coat, white, 0, 0, 0), 1, true, true, 3});
    c.push_back({"coated_diffuse_dark", CoatedDiffuseBsdf(*coat, Rgb(0.5, 0.1, 0.02), 0, 0, 0.01), 1, false, true, 8});
    c.push_back({"coated_diffuse_rough", CoatedDiffuseBsdf(*coat, white, 0.3, 0.3, 0), 1, false, false, 3});
    c.push_back({"coated_diffuse_anisotropic", CoatedDiffuseBsdf(*coat, Rgb(0.5), 0.1, 0.4, 0.1), 1, false, false, 3});
    c.push_back({"coated_conductor", CoatedConductorBsdf(*coat, {0, 0}, 0, kWhite, {0, 0}), 1, true, true});
    c.push_back({"coated_conductor_rough_base", CoatedConductorBsdf(*coat, {0, 0}, 0.01, kGold, {0.2f, 0.4f}), 1, false,
                 false, 2});
    c.push_back({"coated_conductor_rough_coat", CoatedConductorBsdf(*coat, {0.3f, 0.3f}, 0, kWhite, {0, 0}), 1, false,
                 false, 3});
    c.push_back({"coated_conductor_rough", CoatedConductorBsdf(*coat, {0.2f, 0.2f}, 0, kWhite, {0.5f, 0.5f}), 1, false,
                 false, 3});
    return c;
}

} // namespace

const std::vector<BsdfCase>& bsdf_cases() {
    static const std::vector<BsdfCase> cases = make_cases();
    return cases;
}

const std::vector<Vec3>& looks() {
    static const std::vector<Vec3> list{Vec3(0, 0, 1), Vec3(0.3f, -0.2f, 0.8f).normalized(),
                                        Vec3(-0.9f, 0.4f, 0.25f).normalized(), Vec3(0.5f, 0.1f, -0.7f).normalized(),
                                        Vec3(-0.2f, -0.95f, -0.4f).normalized()};
    return list;
}

} // namespace keyhole::test

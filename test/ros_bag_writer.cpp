// SPDX-License-Identifier: BSD-3-Clause
#include "ros_bag_writer.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace photonav::test {
namespace {

constexpr std::uint32_t kChunk = 100000;  // [bytes]: some images each

class Writer {
  public:
    Writer(const std::string& file, const BagWords& words) : words_(words) {
        bag_.open(file, rosbag::bagmode::Write);
        bag_.setChunkThreshold(kChunk);
        bag_.setCompression(words.compression == "bz2"   ? rosbag::compression::BZ2
                            : words.compression == "lz4" ? rosbag::compression::LZ4
                                                         : rosbag::compression::Uncompressed);
    }

    template <typename Message>
    void write(const std::string& topic, double time, Message message) {
        const ros::Time stamp(time);
        if (words_.stampsInHeader) message.header.stamp = stamp;
        bag_.write(topic, stamp, message);
    }

    void image(const std::string& topic, double time, const std::string& encoding,
               const cv::Mat& pixels) {
        sensor_msgs::Image message;
        message.width = static_cast<std::uint32_t>(pixels.cols);
        message.height = static_cast<std::uint32_t>(pixels.rows);
        message.encoding = encoding;
        message.step = static_cast<std::uint32_t>(pixels.step);
        message.data.assign(pixels.data, pixels.data + pixels.total() * pixels.elemSize());
        write(topic, time, message);
    }

    void compressed(const std::string& topic, double time, const std::string& format,
                    std::size_t header, const cv::Mat& pixels, const std::string& extension) {
        std::vector<unsigned char> bytes;
        cv::imencode(extension, pixels, bytes);
        sensor_msgs::CompressedImage message;
        message.format = format;
        message.data.assign(header, 0);
        message.data.insert(message.data.end(), bytes.begin(), bytes.end());
        write(topic, time, message);
    }

    void camera(const std::string& topic, double time, const BagCameraWords& camera, double focal) {
        sensor_msgs::CameraInfo info;
        info.width = camera.width;
        info.height = camera.height;
        info.distortion_model = words_.distortionModel;
        info.D = words_.distortion;
        info.K = {focal * camera.fx, 0., camera.cx, 0., focal * camera.fy, camera.cy, 0., 0., 1.};
        info.P = {info.K[0], 0., info.K[2], 0., 0., info.K[4], info.K[5], 0., 0., 0., 1., 0.};
        write(topic, time, info);
    }

    void pose(double time, const std::array<double, 7>& T_w_c) {
        geometry_msgs::Pose pose;
        pose.position.x = T_w_c[0];
        pose.position.y = T_w_c[1];
        pose.position.z = T_w_c[2];
        pose.orientation.x = T_w_c[3];
        pose.orientation.y = T_w_c[4];
        pose.orientation.z = T_w_c[5];
        pose.orientation.w = T_w_c[6];
        const std::string topic = "/pose";
        if (words_.poseType == "PoseStamped") {
            geometry_msgs::PoseStamped message;
            message.pose = pose;
            write(topic, time, message);
        } else if (words_.poseType == "PoseWithCovarianceStamped") {
            geometry_msgs::PoseWithCovarianceStamped message;
            message.pose.pose = pose;
            write(topic, time, message);
        } else if (words_.poseType == "Odometry") {
            nav_msgs::Odometry message;
            message.child_frame_id = "camera";
            message.pose.pose = pose;
            write(topic, time, message);
        } else if (words_.poseType == "TransformStamped") {
            geometry_msgs::TransformStamped message;
            message.child_frame_id = "camera";
            message.transform.translation.x = pose.position.x;
            message.transform.translation.y = pose.position.y;
            message.transform.translation.z = pose.position.z;
            message.transform.rotation = pose.orientation;
            write(topic, time, message);
        }
    }

    void colour(double time, const std::string& file) {
        const cv::Mat grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
        for (const std::string& topic : words_.imageTopics) {
            if (words_.imageEncoding == "mono8") {
                image(topic, time, "mono8", grey);
            } else if (words_.imageEncoding == "png" || words_.imageEncoding == "jpeg") {
                compressed(topic, time, "mono8; " + words_.imageEncoding + " compressed ", 0, grey,
                           words_.imageEncoding == "png" ? ".png" : ".jpg");
            } else {
                cv::Mat pixels;
                cv::cvtColor(grey, pixels, cv::COLOR_GRAY2BGR);
                image(topic, time, words_.imageEncoding, pixels);
            }
        }
    }

    void depth(double time, const std::string& file, double scale) {
        const cv::Mat values = cv::imread(file, cv::IMREAD_UNCHANGED);
        if (words_.depthEncoding == "32FC1") {
            cv::Mat metres;
            values.convertTo(metres, CV_32F, 1. / scale);
            image(words_.depthTopic, time, "32FC1", metres);
        } else if (words_.depthEncoding == "png") {
            compressed(words_.depthTopic, time, "16UC1; compressedDepth", 12, values, ".png");
        } else {
            image(words_.depthTopic, time, words_.depthEncoding, values);
        }
    }

  private:
    BagWords words_;
    rosbag::Bag bag_;
};

}  // namespace

void writeBag(const std::string& file, const std::vector<BagFrame>& frames,
              const BagCameraWords& camera, double depthScale, const BagWords& words) {
    Writer writer(file, words);
    for (const BagFrame& frame : frames) {
        if (!words.cameraTopic.empty()) writer.camera(words.cameraTopic, frame.time, camera, 1.);
        if (words.depthFocal != 1.) {
            writer.camera("/camera/depth_registered/camera_info", frame.time, camera,
                          words.depthFocal);
        }
        writer.pose(frame.time, frame.T_w_c);
        writer.colour(frame.time, frame.colour);
        if (!words.depthTopic.empty()) writer.depth(frame.time, frame.depth, depthScale);
    }
}

}  // namespace photonav::test
